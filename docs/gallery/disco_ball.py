# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes disco_ball.blend: a turning ball of mirrors in a bar, two seconds, with motion blur."""

import math

from stage import (
    Vector,
    add_faces,
    ball,
    block,
    camera,
    color_world,
    diffuse,
    lathe,
    light,
    metal,
    plate,
    save,
    set_up,
    smooth_line,
    varnished,
)

RADIUS, FRAMES = 0.33, 48


BOTTLE = ((0.0, 0.0), (0.036, 0.0), (0.038, 0.01), (0.038, 0.17), (0.014, 0.22), (0.013, 0.29), (0.0, 0.29))
STOOL = ((0.0, 0.0), (0.19, 0.0), (0.17, 0.02), (0.025, 0.03), (0.025, 0.70), (0.16, 0.71), (0.17, 0.75), (0.0, 0.76))
DRINKS = ((0.05, 0.22, 0.10), (0.45, 0.20, 0.04), (0.40, 0.03, 0.05), (0.06, 0.12, 0.30), (0.40, 0.34, 0.14))


def mirrored_ball(surface, rows=24):
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
    plate("Floor", 0.0, 0.0, 6.0, 5.4, 0.0, varnished("Parquet", (0.16, 0.085, 0.05), 0.22))
    wall = diffuse("Wall", (0.34, 0.31, 0.36))
    for name, a, b in (
        ("Back", (-2.6, 2.2), (2.6, 2.2)),
        ("Left", (-2.6, -2.7), (-2.6, 2.2)),
        ("Right", (2.6, 2.2), (2.6, -2.7)),
    ):
        add_faces(name, [(*a, 0), (*b, 0), (*b, 2.9), (*a, 2.9)], [(3, 2, 1, 0)], wall)
    add_faces("Ceiling", [(-2.6, -2.7, 2.9), (2.6, -2.7, 2.9), (2.6, 2.2, 2.9), (-2.6, 2.2, 2.9)], [(3, 2, 1, 0)], wall)
    bar = varnished("Bar", (0.14, 0.045, 0.025), 0.1)
    block("Bar", (-2.3, 1.35, 0.0), (-0.75, 1.85, 1.05), bar, 0.02)
    for number, x in enumerate((-2.05, -1.80, -1.50, -1.25, -1.02)):
        bottle = lathe(f"Bottle {number}", smooth_line(BOTTLE), varnished(f"Bottle {number}", DRINKS[number], 0.06), 48)
        bottle.location, bottle.scale.z = (x, 1.6 - 0.06 * (number % 2), 1.05), 1.0 + 0.12 * (number % 3)
    chrome = metal("Chrome", (0.80, 0.80, 0.82), 0.08)
    for number, x in enumerate((-2.0, -1.5, -1.0)):
        stool = lathe(f"Stool {number}", STOOL, chrome, 64)
        stool.data.set_sharp_from_angle(angle=math.radians(40))
        stool.location = (x, 1.02, 0.0)
    for x in (1.45, 2.05):
        block("Speaker", (x, 1.55, 0.0), (x + 0.46, 1.95, 1.25), diffuse("Speaker", (0.11, 0.11, 0.13)), 0.02)
    place = Vector((0.2, 0.30, 1.92))
    mirrors = mirrored_ball(metal("Mirror", (0.93, 0.93, 0.93), 0.0))
    mirrors.location = place
    ball("Core", place, 0.985 * RADIUS, diffuse("Core", (0.02, 0.02, 0.02)))
    block(
        "Rod",
        (place.x - 0.01, place.y - 0.01, place.z + RADIUS - 0.01),
        (place.x + 0.01, place.y + 0.01, 2.9),
        diffuse("Rod", (0.1, 0.1, 0.1)),
    )
    for frame, turns in ((1, 0.0), (FRAMES + 1, 0.25)):
        mirrors.rotation_euler.z = math.tau * turns
        mirrors.keyframe_insert("rotation_euler", frame=frame)
    spots = (
        ((-2.3, -1.9, 2.6), (1.0, 0.10, 0.26), 11000.0),
        ((2.4, -1.6, 2.4), (0.10, 0.34, 1.0), 11000.0),
        ((0.5, -2.4, 0.5), (1.0, 0.74, 0.36), 8000.0),
    )
    for number, (source, color, watts) in enumerate(spots):
        # Within the ball, so that no light goes past it.
        angle = 1.86 * math.asin(RADIUS / (place - Vector(source)).length)
        light(
            "SPOT",
            f"Spot {number}",
            source,
            place,
            watts,
            color,
            shadow_soft_size=0.012,
            spot_size=angle,
            spot_blend=0.15,
        )
    light(
        "AREA",
        "Bar Light",
        (-1.5, 1.75, 2.3),
        (-1.5, 1.6, 0.0),
        9.0,
        (1.0, 0.55, 0.25),
        shape="RECTANGLE",
        size=1.4,
        size_y=0.1,
    )
    light(
        "AREA",
        "Blue Light",
        (0.0, -2.5, 2.7),
        (0.0, 2.2, 0.8),
        42.0,
        (0.32, 0.22, 1.0),
        shape="RECTANGLE",
        size=3.0,
        size_y=0.4,
    )
    color_world(scene, (0.4, 0.3, 0.8), 0.10)
    camera((0.05, -2.6, 1.25), (0.02, 0.9, 1.36), 26.0)
    set_up(scene, look="AgX - Punchy", exposure=0.9)
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, FRAMES
    scene.render.use_motion_blur = True


if __name__ == "__main__":
    save(build)
