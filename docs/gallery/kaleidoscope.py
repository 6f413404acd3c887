# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes kaleidoscope.blend: colored glass before three mirrors, as the eye sees it."""

import math
import random

from stage import add_faces, ball, block, camera, color_world, diffuse, glass, light, metal, save, set_up

SIDE, LENGTH = 0.05, 0.30
COLORS = (
    (1.00, 0.24, 0.28),
    (0.20, 0.48, 1.00),
    (1.00, 0.84, 0.20),
    (0.22, 0.90, 0.50),
    (0.80, 0.32, 0.98),
    (1.00, 0.58, 0.22),
    (0.24, 0.90, 0.98),
)


def build(scene):
    mirror = metal("Mirror", (0.95, 0.95, 0.95), 0.0)
    corners = [
        (SIDE * math.cos(math.tau * (k + 0.25) / 3), SIDE * math.sin(math.tau * (k + 0.25) / 3)) for k in range(3)
    ]
    for number in range(3):
        (a, b), (c, d) = corners[number], corners[(number + 1) % 3]
        add_faces(f"Mirror {number}", [(a, 0, b), (c, 0, d), (c, LENGTH, d), (a, LENGTH, b)], [(0, 1, 2, 3)], mirror)
    add_faces(
        "Screen",
        [(-0.12, 0.348, -0.12), (0.12, 0.348, -0.12), (0.12, 0.348, 0.12), (-0.12, 0.348, 0.12)],
        [(0, 1, 2, 3)],
        diffuse("Screen", (0.62, 0.60, 0.56)),
    )
    rng = random.Random(11)
    surfaces = [glass(f"Glass {number}", color, 1.5) for number, color in enumerate(COLORS)]
    for number in range(30):
        surface = surfaces[number % len(surfaces)]
        radius, angle = 0.043 * math.sqrt(rng.uniform(0.0, 1.0)), rng.uniform(0.0, math.tau)
        place = (radius * math.cos(angle), rng.uniform(0.311, 0.334), radius * math.sin(angle))
        if number % 4:
            size = rng.uniform(0.005, 0.0095)
            shard = block(f"Shard {number}", (-size, -0.0016, -1.7 * size), (size, 0.0016, 1.7 * size), surface, 0.0007)
            shard.location = place
            shard.rotation_euler = (rng.uniform(-0.35, 0.35), rng.uniform(0, 3), rng.uniform(-0.35, 0.35))
        else:
            ball(f"Bead {number}", place, rng.uniform(0.0045, 0.008), surface, 24)
    for name, place, watts, color in (
        ("Lamp", (0.13, 0.22, 0.15), 3.0, (1.0, 0.93, 0.82)),
        ("Second Lamp", (-0.17, 0.24, 0.05), 1.8, (0.80, 0.90, 1.0)),
    ):
        light(
            "SPOT",
            name,
            place,
            (0.0, 0.34, 0.0),
            watts,
            color,
            shadow_soft_size=0.002,
            spot_size=math.radians(46),
            spot_blend=0.6,
        )
    color_world(scene, (0.75, 0.85, 1.0), 0.14)
    camera((0.0, -0.02, 0.0), (0.0, 0.34, 0.0), 26.0)
    set_up(scene, width=640, height=640, bounces=16, look="AgX - Punchy", exposure=1.2)


if __name__ == "__main__":
    save(build)
