# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes pool_below.blend: under water in a pool, looking up at the waves in the sun."""

import sys
from pathlib import Path

import bpy
from stage import camera, color_world, save, set_up, sun

sys.path.append(str(Path(__file__).resolve().parents[1] / "samples"))

import pool


def build(scene):
    pool.build_pool()
    checker = next(node for node in bpy.data.materials["Tiles"].node_tree.nodes if node.type == "TEX_CHECKER")
    for socket, color in zip(("Color1", "Color2"), ((0.32, 0.57, 0.62), (0.20, 0.46, 0.55))):
        checker.inputs[socket].default_value = (*color, 1)
    pool.build_ball()
    pool.build_water()
    sun((-0.35, 0.28, -0.9), 6.0)
    color_world(scene, (0.24, 0.46, 0.80), 0.30)
    camera((-1.55, -1.05, -0.80), (0.40, 0.62, -0.55), 18.0)
    set_up(scene, bounces=8, exposure=-0.4)


if __name__ == "__main__":
    save(build)
