# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the pixels by which renderers are compared: ``... adapters.counted SCENE.npz TARGET.npy``."""

import os
import sys

import bpy  # noqa: F401  gives the module its mathutils
import numpy as np

from rppm_addon.scene.storage.storage import load_scene
from tools.pairs.suspects import MOST_TRIANGLES, coincident_pixels


def main(source: str, target: str) -> None:
    """Write (H, W) bool, the top row first: False for pixels that show coincident faces, and for those beside them."""
    scene = load_scene(source)
    width, height = scene.camera.resolution
    counted = np.ones((height, width), bool)
    if scene.triangle_count <= MOST_TRIANGLES:
        wide = np.pad(coincident_pixels(scene, width, height), 1)
        shifts = [(y, x) for y in range(3) for x in range(3)]
        counted = ~np.any([wide[y : y + height, x : x + width] for y, x in shifts], axis=0)
    np.save(target, counted)


if __name__ == "__main__":
    main(*sys.argv[1:])
    sys.stdout.flush()
    os._exit(0)  # the module may hang at its exit
