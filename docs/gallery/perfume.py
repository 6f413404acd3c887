# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes perfume.blend: a square bottle of perfume and its stopper in the evening sun."""

import math

from stage import ball, block, camera, color_world, diffuse, glass, lathe, light, metal, plate, save, set_up

GAP = 0.0004


def build(scene):
    plate("Table", 0.0, 0.0, 6.0, 6.0, 0.0, diffuse("Stone", (0.46, 0.40, 0.36)))
    clear = glass("Glass", (0.995, 1.0, 0.998), 1.52)
    block("Bottle", (-0.028, -0.016, 0.0), (0.028, 0.016, 0.075), clear, 0.004)
    block("Perfume", (-0.022, -0.010, 0.010), (0.022, 0.010, 0.060), glass("Perfume", (0.98, 0.58, 0.28), 1.36), 0.003)
    neck = [(0.0, 0.0755), (0.011, 0.0755), (0.011, 0.086), (0.0, 0.086)]
    lathe("Neck", neck, metal("Gold", (1.0, 0.74, 0.38), 0.06))
    ball("Stopper", (0.0, 0.0, 0.104), 0.018, clear)
    light(
        "SPOT",
        "Evening Sun",
        (1.15, 0.95, 1.00),
        (-0.04, -0.03, 0.0),
        210.0,
        (1.0, 0.80, 0.58),
        shadow_soft_size=0.007,
        spot_size=math.radians(20),
        spot_blend=1.0,
    )
    light(
        "AREA",
        "Window",
        (-0.7, 0.2, 0.5),
        (0.0, 0.0, 0.05),
        1.1,
        (0.55, 0.70, 1.0),
        shape="RECTANGLE",
        size=0.25,
        size_y=0.6,
    )
    color_world(scene, (0.48, 0.56, 0.80), 0.07)
    camera((0.055, -0.385, 0.215), (-0.038, -0.014, 0.042), 45.0)
    set_up(scene, bounces=12)


if __name__ == "__main__":
    save(build)
