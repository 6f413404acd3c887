# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes perfume.blend: a square bottle of perfume and its stopper in the evening sun."""

from stage import ball, block, camera, color_world, diffuse, glass, lathe, metal, plate, save, set_up, sun

GAP = 0.0004


def build(scene):
    plate("Table", 0.0, 0.0, 1.6, 1.2, 0.0, diffuse("Stone", (0.80, 0.76, 0.72)))
    clear = glass("Glass", (0.995, 1.0, 0.998), 1.52)
    block("Bottle", (-0.028, -0.016, 0.0), (0.028, 0.016, 0.075), clear, 0.004)
    block("Perfume", (-0.022, -0.010, 0.010), (0.022, 0.010, 0.060), glass("Perfume", (0.97, 0.60, 0.34), 1.36), 0.003)
    neck = [(0.0, 0.0755), (0.011, 0.0755), (0.011, 0.086), (0.0, 0.086)]
    lathe("Neck", neck, metal("Gold", (1.0, 0.76, 0.40), 0.06))
    ball("Stopper", (0.0, 0.0, 0.104), 0.018, clear)
    block("Box", (0.065, 0.035, 0.0), (0.125, 0.085, 0.095), diffuse("Card", (0.42, 0.10, 0.14)), 0.0015)
    sun((-0.58, -0.48, -0.50), 5.5, (1.0, 0.84, 0.64))
    color_world(scene, (0.48, 0.56, 0.80), 0.35)
    camera((0.085, -0.33, 0.20), (-0.024, -0.012, 0.036), 50.0)
    set_up(scene, bounces=12)


if __name__ == "__main__":
    save(build)
