# SPDX-License-Identifier: GPL-3.0-or-later
"""Voxels from which photons leave the grid of a medium that emits light."""

from dataclasses import dataclass

import numpy as np

from ...gl.buffers.storage_blocks import StorageBlock
from .bricks import Lattice

StorageBlock("EmissionCells", "uvec2 emission_cells[];")
"""By cell the number of its first voxel, x fastest, and where its part of [0, 2^32) begins."""

_MOST_CELLS = 1 << 18


@dataclass(frozen=True)
class EmissionCells:
    """Cells of a grid, each chosen as often as it is bright."""

    records: np.ndarray
    """(n, 2) uint32, as in the block EmissionCells."""
    side: int
    """Voxels along each side of a cell."""
    total: np.ndarray
    """(3,) sum of the emission of all voxels."""

    @classmethod
    def of(cls, emission: np.ndarray, lattice: Lattice) -> "EmissionCells | None":
        """The cells of an emission (bricks, BRICK_VOXELS, 3); None where nothing shines.

        A voxel stands for what linear interpolation makes of it, of which half lies beyond the grid at each end. There
        are at most 2^18 cells.
        """
        channels = [_within(lattice.in_order(emission[..., k : k + 1])[..., 0]) for k in range(3)]
        total = np.array([channel.sum(dtype=np.float64) for channel in channels])
        if not total.sum() > 0.0:
            return None
        sums, side = (channels[0] + channels[1] + channels[2]) / 3.0, 1
        while np.count_nonzero(sums) > _MOST_CELLS:
            sums, side = _halved(sums), 2 * side
        cells = np.stack(np.nonzero(sums), axis=1)
        x, y, z = (side * cells).T
        width, depth, _ = lattice.voxels
        records = np.stack([x + width * (y + depth * z), _starts(sums[tuple(cells.T)])], axis=1)
        return cls(records.astype(np.uint32), side, total)


def _within(values: np.ndarray) -> np.ndarray:
    """(x, y, z) voxels, those at the ends halved along each axis."""
    values = values.copy()
    for axis in range(3):
        ends = np.moveaxis(values, axis, 0)
        ends[0] *= 0.5
        ends[-1] *= 0.5
    return values


def _halved(values: np.ndarray) -> np.ndarray:
    """Sums of 2 x 2 x 2 voxels."""
    values = np.pad(values, [(0, size % 2) for size in values.shape])
    x, y, z = (size // 2 for size in values.shape)
    return values.reshape(x, 2, y, 2, z, 2).sum(axis=(1, 3, 5))


def _starts(weights: np.ndarray) -> np.ndarray:
    """(n,) where the part of [0, 2^32) of each cell begins; none is empty."""
    ends = np.cumsum(weights, dtype=np.float64)
    steps = np.floor(ends / ends[-1] * (2.0**32 - len(weights))) + np.arange(1, len(weights) + 1)
    return np.concatenate([[0.0], steps[:-1]])
