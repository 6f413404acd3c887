# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes kaleidoscope.blend: colored glass before three mirrors, as the eye sees it."""

import math
import random

from stage import add_faces, ball, block, camera, color_world, diffuse, glass, light, metal, save, set_up

SIDE, LENGTH = 0.05, 0.30


def build(scene):
    mirror = metal("Mirror", (0.95, 0.95, 0.95), 0.0)
    corners = [
        (SIDE * math.cos(math.tau * (k + 0.25) / 3), SIDE * math.sin(math.tau * (k + 0.25) / 3)) for k in range(3)
    ]
    for number in range(3):
        (a, b), (c, d) = corners[number], corners[(number + 1) % 3]
        add_faces(f"Mirror {number}", [(a, 0, b), (c, 0, d), (c, LENGTH, d), (a, LENGTH, b)], [(0, 1, 2, 3)], mirror)
    screen = diffuse("Screen", (0.85, 0.85, 0.82))
    add_faces(
        "Screen",
        [(-0.1, 0.345, -0.1), (0.1, 0.345, -0.1), (0.1, 0.345, 0.1), (-0.1, 0.345, 0.1)],
        [(0, 1, 2, 3)],
        screen,
    )
    rng = random.Random(4)
    colors = (
        (0.95, 0.10, 0.12),
        (0.10, 0.35, 0.95),
        (0.98, 0.75, 0.08),
        (0.10, 0.80, 0.30),
        (0.70, 0.15, 0.85),
        (0.98, 0.45, 0.10),
    )
    for number in range(13):
        color = colors[number % len(colors)]
        x, z = rng.uniform(-0.035, 0.035), rng.uniform(-0.03, 0.035)
        y = rng.uniform(0.312, 0.330)
        surface = glass(f"Glass {number}", color, 1.5)
        if number % 3:
            size = rng.uniform(0.004, 0.008)
            shard = block(f"Shard {number}", (-size, -0.003, -1.6 * size), (size, 0.003, 1.6 * size), surface, 0.0008)
            shard.location, shard.rotation_euler = (
                (x, y, z),
                (rng.uniform(-0.4, 0.4), rng.uniform(0, 3), rng.uniform(-0.4, 0.4)),
            )
        else:
            ball(f"Bead {number}", (x, y, z), rng.uniform(0.005, 0.008), surface, 24)
    light(
        "SPOT",
        "Lamp",
        (0.10, 0.20, 0.16),
        (0.0, 0.34, 0.0),
        3.0,
        (1.0, 0.95, 0.88),
        shadow_soft_size=0.003,
        spot_size=math.radians(40),
    )
    light(
        "SPOT",
        "Second Lamp",
        (-0.14, 0.24, 0.10),
        (0.0, 0.34, 0.0),
        1.6,
        (0.85, 0.92, 1.0),
        shadow_soft_size=0.003,
        spot_size=math.radians(40),
    )
    color_world(scene, (0.8, 0.85, 1.0), 0.12)
    camera((0.0, -0.02, 0.0), (0.0, 0.34, 0.0), 24.0)
    set_up(scene, width=480, height=480, bounces=16)


if __name__ == "__main__":
    save(build)
