# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes disco_ball.blend: a turning ball of mirrors in a bar, two seconds, with motion blur."""

import math

from stage import Vector, add_faces, block, camera, color_world, diffuse, light, metal, plate, save, set_up, varnished

RADIUS, FRAMES = 0.24, 48


def mirrored_ball(surface, rows=22):
    """Flat mirrors in rows round a ball."""
    points, faces = [], []
    for row in range(rows):
        low, high = (math.pi * (row + part) / rows - math.pi / 2 for part in (0.04, 0.96))
        count = max(3, round(2 * rows * math.cos(0.5 * (low + high))))
        for k in range(count):
            a, b = (math.tau * (k + part) / count for part in (0.04, 0.96))
            corners = ((a, low), (b, low), (b, high), (a, high))
            first = len(points)
            points += [
                (RADIUS * math.cos(v) * math.cos(u), RADIUS * math.cos(v) * math.sin(u), RADIUS * math.sin(v))
                for u, v in corners
            ]
            faces.append((first, first + 1, first + 2, first + 3))
    return add_faces("Mirrors", points, faces, surface)


def build(scene):
    plate("Floor", 0.0, 0.0, 5.0, 4.4, 0.0, varnished("Parquet", (0.28, 0.16, 0.09), 0.25))
    wall = diffuse("Wall", (0.55, 0.50, 0.55))
    for name, a, b in (
        ("Back", (-2.5, 2.2), (2.5, 2.2)),
        ("Left", (-2.5, -2.2), (-2.5, 2.2)),
        ("Right", (2.5, 2.2), (2.5, -2.2)),
    ):
        add_faces(name, [(*a, 0), (*b, 0), (*b, 2.7), (*a, 2.7)], [(3, 2, 1, 0)], wall)
    add_faces("Ceiling", [(-2.5, -2.2, 2.7), (2.5, -2.2, 2.7), (2.5, 2.2, 2.7), (-2.5, 2.2, 2.7)], [(3, 2, 1, 0)], wall)
    block("Bar", (-2.1, 1.3, 0.0), (-0.5, 1.8, 1.05), varnished("Bar", (0.16, 0.05, 0.03), 0.1), 0.02)
    block("Speaker", (1.5, 1.5, 0.0), (2.1, 2.0, 1.3), diffuse("Speaker", (0.04, 0.04, 0.045)), 0.02)
    place = Vector((0.25, 0.45, 2.05))
    ball = mirrored_ball(metal("Mirror", (0.93, 0.93, 0.93), 0.0))
    core = add_faces("Core", [], [], diffuse("Core", (0.02, 0.02, 0.02)))
    core.parent, ball.location = ball, place
    block(
        "Rod",
        (place.x - 0.01, place.y - 0.01, place.z + RADIUS - 0.01),
        (place.x + 0.01, place.y + 0.01, 2.7),
        diffuse("Rod", (0.1, 0.1, 0.1)),
    )
    for frame, turns in ((1, 0.0), (FRAMES + 1, 0.25)):
        ball.rotation_euler.z = math.tau * turns
        ball.keyframe_insert("rotation_euler", frame=frame)
    spots = (
        ((-1.9, -1.6, 2.5), (1.0, 0.18, 0.30)),
        ((2.2, -1.2, 2.4), (0.20, 0.45, 1.0)),
        ((0.4, -2.0, 0.5), (1.0, 0.80, 0.45)),
    )
    for number, (source, color) in enumerate(spots):
        angle = 2.3 * math.asin(RADIUS / (place - Vector(source)).length)
        light(
            "SPOT",
            f"Spot {number}",
            source,
            place,
            6000.0,
            color,
            shadow_soft_size=0.015,
            spot_size=angle,
            spot_blend=0.1,
        )
    color_world(scene, (0.4, 0.4, 0.8), 0.05)
    camera((0.1, -2.15, 1.15), (0.05, 0.9, 1.42), 20.0)
    set_up(scene)
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, FRAMES
    scene.render.use_motion_blur = True


if __name__ == "__main__":
    save(build)
