# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes aquarium.blend: waves, sand and fishes under one lamp, two seconds."""

import math
import random

from stage import (
    Vector,
    add_faces,
    ball,
    block,
    camera,
    color_world,
    diffuse,
    glass,
    lathe,
    light,
    plate,
    save,
    set_up,
    smooth_line,
)

HALF, DEPTH, LEVEL, WALL, FRAMES = (0.40, 0.17), 0.30, 0.27, 0.006, 48
GAP = 0.0005


def water(surface, columns=96, rows=48):
    """A closed body of water whose top has waves, by shape keys that follow each other."""
    a, b = HALF[0] - GAP, HALF[1] - GAP

    def height(x, y, time):
        waves = ((0.23, 20, 0.0022), (0.17, -35, 0.0018), (0.11, 100, 0.0012), (0.08, 160, 0.0009))
        total = LEVEL
        for number, (length, degrees, amplitude) in enumerate(waves):
            k = math.tau / length
            along = x * math.cos(math.radians(degrees)) + y * math.sin(math.radians(degrees))
            total += amplitude * math.sin(k * along - math.sqrt(9.81 * k) * time + 1.7 * number)
        return total

    def grid(time):
        top = [
            (x, y, height(x, y, time))
            for y in (b * (2 * j / rows - 1) for j in range(rows + 1))
            for x in (a * (2 * i / columns - 1) for i in range(columns + 1))
        ]
        return top + [(x, y, GAP) for x, y, _ in top]

    across, count = columns + 1, (columns + 1) * (rows + 1)
    faces = []
    for j in range(rows):
        for i in range(columns):
            k = j * across + i
            faces += [
                (k, k + 1, k + 1 + across, k + across),
                (count + k, count + k + across, count + k + across + 1, count + k + 1),
            ]
    border = [
        *range(columns),
        *(columns + across * j for j in range(rows)),
        *(across * rows + columns - i for i in range(columns)),
        *(across * (rows - j) for j in range(rows)),
    ]
    for k, here in enumerate(border):
        after = border[(k + 1) % len(border)]
        faces.append((here, count + here, count + after, after))
    made = add_faces("Water", grid(0.0), faces, surface)
    made.shape_key_add(name="Basis")
    steps = 12
    for step in range(1, steps + 1):
        key = made.shape_key_add(name=f"Time {step}")
        for vertex, point in zip(key.data, grid(2.0 * step / steps)):
            vertex.co = point
        for frame, value in ((step - 1, 0.0), (step, 1.0), (step + 1, 0.0)):
            key.value = value
            key.keyframe_insert("value", frame=1 + frame * FRAMES / steps)
    for polygon in made.data.polygons:
        polygon.use_smooth = polygon.index < 2 * rows * columns
    return made


def fish(name, color, place, turn, size):
    """A fish along its X axis."""
    body = lathe(
        name,
        smooth_line(((0.0, -0.5), (0.10, -0.42), (0.19, -0.15), (0.16, 0.15), (0.05, 0.42), (0.0, 0.46))),
        diffuse(name, color),
        32,
    )
    tail = add_faces(
        f"{name} Tail",
        [(0, 0, 0.40), (0.17, 0.0, 0.66), (0.06, 0.0, 0.60), (-0.06, 0.0, 0.60), (-0.17, 0, 0.66)],
        [(0, 1, 2), (0, 2, 3), (0, 3, 4)],
        diffuse(f"{name} Tail", color),
    )
    tail.parent = body
    body.scale, body.location = (size, 0.45 * size, size), place
    body.rotation_euler = (0.0, math.radians(90), turn)
    for frame, along in ((1, 0.0), (FRAMES + 1, -0.06)):
        body.location = Vector(place) + Vector((along * math.cos(turn), along * math.sin(turn), 0.0))
        body.keyframe_insert("location", frame=frame)


def build(scene):
    a, b = HALF
    plate("Table", 0.0, 0.0, 3.0, 2.0, -WALL, diffuse("Table", (0.28, 0.20, 0.15)))
    add_faces(
        "Wall",
        [(-1.5, 0.7, -0.1), (1.5, 0.7, -0.1), (1.5, 0.7, 1.4), (-1.5, 0.7, 1.4)],
        [(3, 2, 1, 0)],
        diffuse("Wall", (0.50, 0.55, 0.58)),
    )
    clear = glass("Glass", (0.98, 1.0, 0.99), 1.5)
    block("Front", (-a - WALL, -b - WALL, 0), (a + WALL, -b, DEPTH), clear)
    block("Back", (-a - WALL, b, 0), (a + WALL, b + WALL, DEPTH), clear)
    block("Left", (-a - WALL, -b + GAP, 0), (-a, b - GAP, DEPTH), clear)
    block("Right", (a, -b + GAP, 0), (a + WALL, b - GAP, DEPTH), clear)
    block("Bottom", (-a, -b, -WALL + GAP), (a, b, -GAP), diffuse("Bottom", (0.3, 0.3, 0.3)))
    water(glass("Water", (0.93, 0.985, 0.99), 1.333))
    rng = random.Random(2)
    columns, rows, sand = 80, 36, []
    for j in range(rows + 1):
        for i in range(columns + 1):
            x, y = (2 * i / columns - 1) * (a - 0.004), (2 * j / rows - 1) * (b - 0.004)
            sand.append((x, y, 0.022 + 0.010 * math.sin(9 * x + 2) * math.cos(13 * y) + 0.0012 * rng.random()))
    faces = [
        (k, k + 1, k + columns + 2, k + columns + 1)
        for j in range(rows)
        for k in range(j * (columns + 1), j * (columns + 1) + columns)
    ]
    add_faces("Sand", sand, faces, diffuse("Sand", (0.76, 0.66, 0.48))).data.shade_smooth()
    for number, (x, y, radius) in enumerate(((-0.25, 0.07, 0.05), (-0.18, 0.02, 0.03), (0.28, 0.08, 0.045))):
        ball(f"Stone {number}", (x, y, 0.03), radius, diffuse(f"Stone {number}", (0.30, 0.30, 0.33)), 16)
    fish("Goldfish", (0.92, 0.30, 0.05), (-0.06, -0.03, 0.14), 0.25, 0.11)
    fish("Second Goldfish", (0.95, 0.52, 0.10), (0.15, 0.05, 0.19), -0.2, 0.08)
    fish("Blue Fish", (0.10, 0.30, 0.75), (0.20, -0.06, 0.10), 2.9, 0.07)
    light(
        "SPOT",
        "Lamp",
        (0.12, -0.05, 1.10),
        (0.0, 0.0, 0.0),
        30.0,
        (1.0, 0.95, 0.85),
        shadow_soft_size=0.01,
        spot_size=math.radians(52),
        spot_blend=0.3,
    )
    color_world(scene, (0.5, 0.6, 0.8), 0.25)
    camera((-0.22, -1.10, 0.52), (0.0, 0.0, 0.115), 44.0)
    set_up(scene, bounces=12)
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, FRAMES


if __name__ == "__main__":
    save(build)
