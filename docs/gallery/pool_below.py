# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes pool_below.blend: under water in a pool, looking up at the waves in the sun."""

from pool_scenes import build_pool
from stage import camera, color_world, save, set_up, sun


def build(scene):
    build_pool((0.32, 0.57, 0.62), (0.20, 0.46, 0.55))
    sun((-0.35, 0.28, -0.9), 6.0)
    color_world(scene, (0.24, 0.46, 0.80), 0.30)
    camera((-1.55, -1.05, -0.80), (0.40, 0.62, -0.55), 18.0)
    set_up(scene, bounces=8, exposure=-0.4)


if __name__ == "__main__":
    save(build)
