# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenVDB files for tests, written by the module that Blender brings along."""

from pathlib import Path

import bpy
import numpy as np


def write_vdb(path: Path, matrix: np.ndarray, **grids: np.ndarray) -> Path:
    """Write grids by name, (x, y, z) or (x, y, z, 3) float32, whose voxels have their centers where a matrix (4, 4)
    places their indices."""
    bpy.utils.expose_bundled_modules()
    import openvdb

    written = []
    for name, values in grids.items():
        grid = openvdb.FloatGrid() if values.ndim == 3 else openvdb.Vec3SGrid()
        grid.name = name
        grid.copyFromArray(np.ascontiguousarray(values, np.float32))
        grid.transform = openvdb.createLinearTransform(matrix.T.tolist())
        written.append(grid)
    openvdb.write(str(path), grids=written)
    return path
