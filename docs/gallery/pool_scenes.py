# SPDX-License-Identifier: GPL-3.0-or-later
"""The pool of the samples, as the gallery's scenes below its water show it."""

import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parents[1] / "samples"))

import pool

__all__ = ["build_pool", "pool"]


def build_pool(first, second):
    """The basin with tiles of two colors, the ball and the water."""
    pool.build_pool()
    checker = next(node for node in bpy.data.materials["Tiles"].node_tree.nodes if node.type == "TEX_CHECKER")
    for socket, color in zip(("Color1", "Color2"), (first, second)):
        checker.inputs[socket].default_value = (*color, 1)
    pool.build_ball()
    pool.build_water()
