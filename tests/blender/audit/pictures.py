# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the current scene by Cycles, to be compared."""

from pathlib import Path

import bpy
import numpy as np
from exr import read_channels, write_exr


def cycles_picture(folder: Path) -> dict[str, np.ndarray]:
    """Return Cycles' picture of a few samples with all of its passes, by the names of their channels."""
    scene = bpy.context.scene
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    write_exr(scene, folder / "cycles.exr")
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    try:
        bpy.ops.render.render(write_still=True)
    finally:
        render.engine = "RPPM"
    channels, _ = read_channels(render.filepath)
    return {name: pixels for name, pixels in channels.items() if "Render Time" not in name}


def are_equal(first: dict[str, np.ndarray], second: dict[str, np.ndarray]) -> bool:
    """Return whether two pictures have the same channels and, but for rounding, the same values."""
    return first.keys() == second.keys() and all(
        np.allclose(values, second[name], rtol=1e-5, atol=1e-6, equal_nan=True) for name, values in first.items()
    )
