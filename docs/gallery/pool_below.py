# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes pool_below.blend: under water in a pool, looking up at the waves in the sun."""

import sys
from pathlib import Path

from stage import camera, color_world, save, set_up, sun

sys.path.append(str(Path(__file__).resolve().parents[1] / "samples"))

import pool


def build(scene):
    pool.build_pool()
    pool.build_ball()
    pool.build_water()
    sun((-0.35, 0.28, -0.9), 4.0)
    color_world(scene, (0.30, 0.48, 0.75), 0.7)
    camera((-1.55, -1.10, -0.75), (0.75, 0.45, -0.62), 18.0)
    set_up(scene, bounces=8)


if __name__ == "__main__":
    save(build)
