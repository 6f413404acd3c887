# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes kaleidoscope.blend: colored glass before three mirrors, as the eye sees it."""

import math
import random

from stage import add_faces, ball, block, camera, color_world, diffuse, glass, light, metal, save, set_up

SIDE, LENGTH, SCREEN = 0.05, 0.345, 0.346
COLORS = (
    (1.00, 0.36, 0.42),
    (0.36, 0.60, 1.00),
    (1.00, 0.88, 0.34),
    (0.38, 0.94, 0.60),
    (0.86, 0.46, 0.99),
    (1.00, 0.68, 0.36),
    (0.40, 0.93, 0.99),
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
        [(-0.06, SCREEN, -0.06), (0.06, SCREEN, -0.06), (0.06, SCREEN, 0.06), (-0.06, SCREEN, 0.06)],
        [(0, 1, 2, 3)],
        diffuse("Screen", (0.80, 0.79, 0.76)),
    )
    rng = random.Random(11)
    surfaces = [glass(f"Glass {number}", color, 1.5) for number, color in enumerate(COLORS)]
    for number in range(30):
        surface = surfaces[number % len(surfaces)]
        radius, angle = 0.043 * math.sqrt(rng.uniform(0.0, 1.0)), rng.uniform(0.0, math.tau)
        place = (radius * math.cos(angle), rng.uniform(0.312, 0.334), radius * math.sin(angle))
        if number % 4:
            size = rng.uniform(0.005, 0.0095)
            shard = block(f"Shard {number}", (-size, -0.0016, -1.7 * size), (size, 0.0016, 1.7 * size), surface, 0.0007)
            shard.location = place
            shard.rotation_euler = (rng.uniform(-0.35, 0.35), rng.uniform(0, 3), rng.uniform(-0.35, 0.35))
        else:
            ball(f"Bead {number}", place, rng.uniform(0.0045, 0.008), surface, 24)
    # Beside the eye: their light comes by the mirrors, too.
    for name, place, watts, color in (
        ("Lamp", (0.010, -0.025, 0.016), 0.5, (1.0, 0.93, 0.82)),
        ("Second Lamp", (-0.016, -0.025, -0.004), 0.3, (0.80, 0.90, 1.0)),
    ):
        light(
            "SPOT",
            name,
            place,
            (0.0, LENGTH, 0.0),
            watts,
            color,
            shadow_soft_size=0.001,
            spot_size=math.radians(30),
            spot_blend=0.3,
        )
    color_world(scene, (0.75, 0.85, 1.0), 0.14)
    camera((0.0, -0.02, 0.0), (0.0, 0.34, 0.0), 26.0)
    set_up(scene, width=640, height=640, bounces=16, look="AgX - Punchy", exposure=1.4)


if __name__ == "__main__":
    save(build)
