# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes: grids of voxels with the values that the nodes of a volume read."""

from dataclasses import dataclass, field

import numpy as np

from .common.declared import declared


@dataclass
class VolumeGrid:
    """Values at the centers of voxels, 0 beyond them."""

    values: np.ndarray = field(metadata=declared("x", "y", "z", "channels", types="float32", finite=False))
    """(x, y, z, 1 to 4) float32; colors are linear Rec.709."""
    matrix: np.ndarray = field(metadata=declared(4, 4))
    """(4, 4) float64 from the indices of voxels to object space: voxel (i, j, k) has its center at (i, j, k)."""


@dataclass
class Volume:
    """Grids that fill a mesh, which is the box around them."""

    grids: dict[str, VolumeGrid] = field(default_factory=dict)
    """By the names of the attributes that they are."""
    scales_density: bool = False
    """Whether coefficients are by length in the space of the object; else by length in the world."""
