# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes chandelier.blend: crystals round three bulbs scatter their light over the walls of a hall."""

import math

from stage import add_faces, camera, color_world, diffuse, glass, lathe, light, metal, save, set_up, torus

TOP, BACK, REACH = 2.45, 0.85, 1.25
"""The ceiling's height, where the wall is, and how far the hall goes to the sides."""


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


def hang(scene, shared, radius, count, height, shift=0.0):
    """Crystals in a ring."""
    for k in range(count):
        made = shared.copy()
        scene.collection.objects.link(made)
        angle = math.tau * (k + shift) / count
        made.location, made.rotation_euler.z = (radius * math.cos(angle), radius * math.sin(angle), height), angle


def build(scene):
    wall = diffuse("Plaster", (0.30, 0.24, 0.20))
    a, b, top = REACH, BACK, TOP
    for name, corners in (
        ("Back", [(-a, b, 0), (a, b, 0), (a, b, top), (-a, b, top)]),
        ("Left", [(-a, -3, 0), (-a, b, 0), (-a, b, top), (-a, -3, top)]),
        ("Right", [(a, b, 0), (a, -3, 0), (a, -3, top), (a, b, top)]),
        ("Ceiling", [(-a, b, top), (a, b, top), (a, -3, top), (-a, -3, top)]),
    ):
        add_faces(name, corners, [(3, 2, 1, 0)], wall)
    crystal, gold = glass("Crystal", (1.0, 1.0, 1.0), 1.6), metal("Gold", (1.0, 0.74, 0.36), 0.1)
    long, short = drop("Long Crystal", 0.12, crystal), drop("Short Crystal", 0.075, crystal)
    for radius, count, height in ((0.36, 30, 1.86), (0.28, 24, 1.76), (0.20, 18, 1.67), (0.12, 11, 1.59)):
        hoop = torus("Hoop", radius, 0.006, gold, 96, 12)
        hoop.location.z = height + 0.006
        hang(scene, long, radius, count, height)
    long.location = (0.0, 0.0, 1.53)
    # Strings of small ones from the top to the widest hoop.
    for step, (radius, count, height) in enumerate(
        ((0.30, 22, 1.98), (0.225, 18, 2.06), (0.15, 13, 2.13), (0.085, 8, 2.19))
    ):
        hang(scene, short, radius, count, height, 0.5 * (step % 2))
    short.location = (0.0, 0.0, 1.44)
    lathe("Rod", [(0.0, 2.08), (0.010, 2.08), (0.010, TOP), (0.0, TOP)], gold, 24)
    crown = torus("Crown", 0.06, 0.010, gold, 64, 16)
    crown.location.z = 2.22
    for k in range(3):
        angle = math.tau * (k + 0.2) / 3
        light(
            "POINT",
            f"Bulb {k}",
            (0.10 * math.cos(angle), 0.10 * math.sin(angle), 1.86),
            (0, 0, 0),
            13.0,
            (1.0, 0.87, 0.68),
            shadow_soft_size=0.005,
        )
    color_world(scene, (0.3, 0.45, 0.9), 0.10)
    camera((0.30, -1.75, 1.52), (0.02, 0.0, 1.90), 30.0)
    set_up(scene, bounces=12)


if __name__ == "__main__":
    save(build)
