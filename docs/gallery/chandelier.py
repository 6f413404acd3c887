# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes chandelier.blend: crystals round five bulbs scatter their light over the walls of a small hall."""

import math

from stage import add_faces, ball, camera, color_world, diffuse, glass, lathe, light, metal, plate, save, set_up, torus

TOP = 2.75


def drop(name, length, surface, sides=6):
    """A cut crystal that hangs from its tip."""
    levels = ((0.10, 0.0), (0.34, -0.30), (0.40, -0.62), (0.22, -0.88))
    points = [(0.0, 0.0, 0.0)]
    for level, (radius, height) in enumerate(levels):
        turns = [math.tau * (k + 0.5 * (level % 2)) / sides for k in range(sides)]
        points += [
            (0.5 * length * radius * math.cos(t), 0.5 * length * radius * math.sin(t), length * height) for t in turns
        ]
    points.append((0.0, 0.0, -length))
    last, faces = len(points) - 1, []
    for k in range(sides):
        after = (k + 1) % sides
        faces.append((0, 1 + k, 1 + after))
        for level in range(len(levels) - 1):
            low, high, shift = 1 + level * sides, 1 + (level + 1) * sides, level % 2
            if shift:
                faces += [(low + k, high + after, low + after), (low + k, high + k, high + after)]
                continue
            faces += [(low + k, high + k, low + after), (low + after, high + k, high + after)]
        end = 1 + (len(levels) - 1) * sides
        faces.append((end + k, last, end + after))
    return add_faces(name, points, faces, surface)


def build(scene):
    wall = diffuse("Plaster", (0.76, 0.71, 0.62))
    plate("Floor", 0.0, 0.0, 3.6, 3.6, 0.0, diffuse("Floor", (0.35, 0.22, 0.14)))
    for name, a, b in (
        ("Back", (-1.8, 1.8), (1.8, 1.8)),
        ("Left", (-1.8, -1.8), (-1.8, 1.8)),
        ("Right", (1.8, 1.8), (1.8, -1.8)),
    ):
        add_faces(name, [(*a, 0), (*b, 0), (*b, TOP), (*a, TOP)], [(3, 2, 1, 0)], wall)
    add_faces("Ceiling", [(-1.8, -1.8, TOP), (1.8, -1.8, TOP), (1.8, 1.8, TOP), (-1.8, 1.8, TOP)], [(3, 2, 1, 0)], wall)
    crystal, gold = glass("Crystal", (1.0, 1.0, 1.0), 1.6), metal("Gold", (1.0, 0.76, 0.38), 0.1)
    shared = drop("Crystal", 0.13, crystal)
    hung = [(0.42, 16, 1.90), (0.30, 12, 1.74), (0.18, 8, 1.62)]
    for radius, count, height in hung:
        hoop = torus("Hoop", radius, 0.008, gold, 96, 12)
        hoop.location.z = height + 0.008
        for k in range(count):
            made = shared.copy()
            scene.collection.objects.link(made)
            angle = math.tau * k / count
            made.location, made.rotation_euler.z = (radius * math.cos(angle), radius * math.sin(angle), height), angle
    shared.location = (0.0, 0.0, 1.60)
    rod = lathe("Rod", [(0.0, 1.6), (0.012, 1.6), (0.012, TOP), (0.0, TOP)], gold, 24)
    rod.location.z = 0.0
    ball("Knob", (0.0, 0.0, 1.64), 0.03, gold, 24)
    for k in range(5):
        angle = math.tau * k / 5
        light(
            "POINT",
            f"Bulb {k}",
            (0.24 * math.cos(angle), 0.24 * math.sin(angle), 1.98),
            (0, 0, 0),
            14.0,
            (1.0, 0.80, 0.52),
            shadow_soft_size=0.006,
        )
    color_world(scene, (0.3, 0.4, 0.7), 0.02)
    camera((0.25, -2.6, 1.20), (0.0, 0.3, 1.78), 27.0)
    set_up(scene, bounces=10)


if __name__ == "__main__":
    save(build)
