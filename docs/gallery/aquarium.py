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
    wood,
)

HALF, DEPTH, LEVEL, WALL, FRAMES = (0.40, 0.17), 0.30, 0.27, 0.006, 48
GAP = 0.0005


def water(surface, columns=96, rows=48):
    """A closed body of water whose top has waves, by shape keys that follow each other."""
    a, b = HALF[0] - GAP, HALF[1] - GAP

    def height(x, y, time):
        waves = ((0.23, 20, 0.0022), (0.17, -35, 0.0018), (0.11, 100, 0.0016), (0.08, 160, 0.0012))
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
    fins = add_faces(
        f"{name} Fins",
        [
            *((0.0, 0.0, 0.38), (0.20, 0.0, 0.70), (0.05, 0.0, 0.60), (-0.05, 0.0, 0.60), (-0.20, 0.0, 0.70)),
            *((-0.14, 0.0, -0.24), (-0.31, 0.0, -0.02), (-0.27, 0.0, 0.14), (-0.10, 0.0, 0.24)),
            *((0.14, 0.0, -0.08), (0.29, 0.0, 0.10), (0.11, 0.0, 0.10)),
        ],
        [(0, 1, 2), (0, 2, 3), (0, 3, 4), (5, 6, 7, 8), (9, 10, 11)],
        diffuse(f"{name} Fins", tuple(0.75 * c for c in color)),
    )
    black = diffuse(f"{name} Eye", (0.01, 0.01, 0.01))
    eyes = [ball(f"{name} Eye", (-0.045, side, -0.33), 0.028, black, 12) for side in (-0.105, 0.105)]
    for part in (fins, *eyes):
        part.parent = body
    body.scale, body.location = (size, 0.45 * size, size), place
    body.rotation_euler = (0.0, math.radians(90), turn)
    for frame, along in ((1, 0.0), (FRAMES + 1, -0.06)):
        body.location = Vector(place) + Vector((along * math.cos(turn), along * math.sin(turn), 0.0))
        body.keyframe_insert("location", frame=frame)


def weed(place, height, number, surface):
    """A ribbon that stands in the sand and bends."""
    points, steps = [], 16
    for k in range(steps + 1):
        t = k / steps
        bend = 0.022 * t * math.sin(4.5 * t + 1.3 * number)
        half = 0.0055 * (1.0 - 0.85 * t * t)
        points += [(bend - half, 0.3 * bend, height * t), (bend + half, -0.4 * bend, height * t)]
    made = add_faces("Weed", points, [(2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2) for k in range(steps)], surface)
    made.data.shade_smooth()
    made.location, made.rotation_euler.z = place, 0.9 * number


def build(scene):
    a, b = HALF
    plate("Table", 0.0, 0.0, 3.0, 2.0, -WALL, wood("Table", (0.05, 0.024, 0.012), (0.17, 0.085, 0.04)))
    add_faces(
        "Wall",
        [(-1.5, 0.7, -0.1), (1.5, 0.7, -0.1), (1.5, 0.7, 1.4), (-1.5, 0.7, 1.4)],
        [(3, 2, 1, 0)],
        diffuse("Wall", (0.13, 0.30, 0.36)),
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
    for j in range(-1, rows + 1):  # the first row is the edge below, behind the pane
        for i in range(columns + 1):
            x, y = (2 * i / columns - 1) * (a - 0.004), (2 * max(j, 0) / rows - 1) * (b - 0.004)
            z = 0.022 + 0.010 * math.sin(9 * x + 2) * math.cos(13 * y) + 0.0012 * rng.random()
            sand.append((x, y, z if j >= 0 else 0.002))
    faces = [
        (k, k + 1, k + columns + 2, k + columns + 1)
        for j in range(rows + 1)
        for k in range(j * (columns + 1), j * (columns + 1) + columns)
    ]
    add_faces("Sand", sand, faces, diffuse("Sand", (0.76, 0.66, 0.48))).data.shade_smooth()
    stones = ((-0.27, 0.08, 0.055), (-0.19, 0.03, 0.03), (0.29, 0.09, 0.05), (0.33, 0.0, 0.025))
    for number, (x, y, radius) in enumerate(stones):
        ball(f"Stone {number}", (x, y, 0.02), radius, diffuse(f"Stone {number}", (0.24, 0.23, 0.24)), 16).scale.z = 0.8
    green = diffuse("Weed", (0.07, 0.26, 0.05))
    for number in range(9):
        side, along = (-0.31, 0.24)[number % 2], 0.035 * (number // 2)
        weed((side + along, 0.115 - 0.02 * (number % 3), 0.02), 0.11 + 0.055 * ((number * 5) % 4) / 3, number, green)
    fish("Goldfish", (0.92, 0.26, 0.03), (-0.07, -0.04, 0.135), 0.25, 0.13)
    fish("Second Goldfish", (0.95, 0.50, 0.06), (0.14, 0.05, 0.19), -0.2, 0.09)
    fish("Blue Fish", (0.06, 0.26, 0.80), (0.21, -0.05, 0.095), 2.9, 0.085)
    fish("Small Fish", (0.85, 0.80, 0.70), (-0.22, 0.0, 0.20), 3.3, 0.06)
    light(
        "SPOT",
        "Lamp",
        (0.14, -0.04, 1.10),
        (0.0, 0.0, 0.0),
        60.0,
        (1.0, 0.95, 0.85),
        shadow_soft_size=0.008,
        spot_size=math.radians(48),
        spot_blend=0.5,
    )
    light(
        "AREA",
        "Wall Light",
        (-0.1, 0.45, 0.75),
        (-0.1, 0.7, 0.25),
        3.0,
        (0.55, 0.85, 1.0),
        shape="RECTANGLE",
        size=0.9,
        size_y=0.05,
    )
    color_world(scene, (0.5, 0.65, 0.8), 0.14)
    camera((-0.16, -1.03, 0.37), (0.012, 0.0, 0.128), 38.0)
    set_up(scene, bounces=12, exposure=0.3)
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, FRAMES


if __name__ == "__main__":
    save(build)
