# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes wine_glasses.blend: two glasses of wine on a table in the low sun."""

from stage import Vector, camera, color_world, diffuse, glass, lathe, plate, save, set_up, smooth_line, sun

OUTER = ((0.0, 0.0), (0.034, 0.0), (0.035, 0.0015), (0.02, 0.005), (0.006, 0.010), (0.004, 0.03), (0.004, 0.075),
         (0.010, 0.088), (0.030, 0.105), (0.041, 0.135), (0.040, 0.170), (0.034, 0.205))  # fmt: skip
INNER = ((0.0328, 0.205), (0.0386, 0.170), (0.0396, 0.135), (0.0285, 0.1065), (0.009, 0.091), (0.0, 0.0895))
LEVEL = 0.142
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
    plate("Table", 0.0, 0.1, 2.4, 1.6, 0.0, diffuse("Cloth", (0.82, 0.79, 0.74)))
    wine_glass(Vector((-0.055, 0.01, 0.0)), (0.62, 0.05, 0.09))
    wine_glass(Vector((0.075, 0.075, 0.0)), (0.98, 0.86, 0.42))
    sun((0.62, -0.56, -0.52), 6.0, (1.0, 0.86, 0.66))
    color_world(scene, (0.45, 0.58, 0.85), 0.35)
    camera((0.06, -0.62, 0.40), (0.065, -0.025, 0.075), 46.0)
    set_up(scene, bounces=12)


if __name__ == "__main__":
    save(build)
