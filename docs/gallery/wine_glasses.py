# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes wine_glasses.blend: two glasses of wine in the last sun, which comes from behind them."""

import math

from stage import Vector, camera, color_world, glass, lathe, light, plate, save, set_up, smooth_line, wood

STEM = -0.030
OUTER = (
    (0.0, 0.0), (0.034, 0.0), (0.035, 0.0015), (0.02, 0.005), (0.006, 0.010), (0.004, 0.025), (0.004, 0.075 + STEM),
    (0.010, 0.088 + STEM), (0.030, 0.105 + STEM), (0.043, 0.135 + STEM), (0.042, 0.165 + STEM), (0.035, 0.205 + STEM),
)  # fmt: skip
INNER = (
    (0.0338, 0.205 + STEM), (0.0406, 0.165 + STEM), (0.0416, 0.135 + STEM), (0.0285, 0.1065 + STEM),
    (0.009, 0.091 + STEM), (0.0, 0.0895 + STEM),
)  # fmt: skip
LEVEL = 0.142 + STEM
GAP = 0.0003


def wine_glass(place, wine_color):
    clear = glass("Glass", (0.995, 1.0, 0.998), 1.5)
    base, bowl = list(OUTER[:3]), smooth_line(OUTER[3:])
    inside = smooth_line(INNER)
    made = lathe("Glass", [*base, *bowl, *inside], clear)
    below = [(max(radius - GAP, 0.0), height + GAP) for radius, height in inside if height < LEVEL - GAP]
    edge = below[0][0]
    wine = glass("Wine", wine_color, 1.34)
    drink = lathe("Wine", [(0.0, below[-1][1]), *reversed(below[:-1]), (edge, LEVEL), (0.0, LEVEL)], wine)
    made.location = drink.location = place


def build(scene):
    oak = wood("Oak", (0.20, 0.115, 0.06), (0.42, 0.29, 0.17), 0.4, 24.0, 2.5)
    plate("Table", 0.0, 0.6, 6.0, 4.0, 0.0, oak)
    wine_glass(Vector((-0.085, 0.0, 0.0002)), (0.88, 0.10, 0.13))
    wine_glass(Vector((0.060, 0.085, 0.0002)), (1.0, 0.88, 0.42))
    light(
        "SPOT",
        "Low Sun",
        (-1.40, 1.55, 1.95),
        (0.06, -0.05, 0.0),
        620.0,
        (1.0, 0.82, 0.60),
        shadow_soft_size=0.012,
        spot_size=math.radians(30),
        spot_blend=1.0,
    )
    light(
        "AREA",
        "Window",
        (1.0, 0.5, 0.6),
        (0.0, 0.0, 0.1),
        7.0,
        (0.55, 0.72, 1.0),
        shape="RECTANGLE",
        size=0.4,
        size_y=1.0,
    )
    color_world(scene, (0.45, 0.58, 0.85), 0.06)
    camera((0.06, -0.66, 0.35), (0.035, -0.050, 0.058), 42.0)
    set_up(scene, bounces=12, exposure=-0.35)


if __name__ == "__main__":
    save(build)
