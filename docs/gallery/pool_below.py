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
    sun((-0.35, 0.28, -0.9), 3.2)
    color_world(scene, (0.24, 0.46, 0.80), 0.32)
    camera((-1.62, -1.12, -0.72), (0.55, 0.40, -0.60), 17.0)
    set_up(scene, bounces=8, look="AgX - Punchy")


if __name__ == "__main__":
    save(build)
