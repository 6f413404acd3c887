# SPDX-License-Identifier: GPL-3.0-or-later
"""Voxels from which photons leave the grid of a medium that emits light."""

from dataclasses import dataclass

import numpy as np

from ...gl.buffers.storage_blocks import StorageBlock
from ...scene.volumes import VolumeMotion
from .bricks import BRICK_SIDE, Lattice

StorageBlock("EmissionCells", "uvec2 emission_cells[];")
"""By cell the number of its first voxel, x fastest, and where its part of [0, 2^32) begins."""

_MOST_CELLS = 1 << 18
_SWEPT_SIDE = 4
"""Voxels along a side of a cell whose values move."""
_MOMENTS = 8
"""Moments of the shutter's time at which moving values are looked for."""
_EVEN = 0.1
"""Part of the light of moving values that is spread evenly."""


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
        brightness, total = _brightness(emission, lattice)
        return cls._of_sums(brightness, 1, total, lattice) if total.sum() > 0.0 else None

    @classmethod
    def swept(
        cls, emission: np.ndarray, lattice: Lattice, motion: VolumeMotion, reached: np.ndarray
    ) -> "EmissionCells | None":
        """The cells of an emission (bricks, BRICK_VOXELS, 3) whose values move; None where nothing shines.

        Cells of 4 x 4 x 4 voxels are as bright as they are on average while the shutter is open. A tenth of all light
        is spread evenly over the bricks that light comes to, ``reached``, (bricks,) bool: none shines that photons do
        not leave.
        """
        brightness, total = _brightness(emission, lattice)
        if not total.sum() > 0.0:
            return None
        sums = _halved(_halved(brightness))
        cells = np.stack(np.meshgrid(*map(np.arange, sums.shape), indexing="ij"), axis=-1).reshape(-1, 3)
        places = lattice.low + lattice.spacing * (_SWEPT_SIDE * (cells + 0.5) - 0.5)
        most = np.array(sums.shape) - 1
        mean = np.zeros(len(cells))
        for time in (np.arange(_MOMENTS) + 0.5) / _MOMENTS:
            at = (motion.sources(places, time) - lattice.low) / lattice.spacing
            mean += sums[tuple(np.clip((at + 0.5) // _SWEPT_SIDE, 0, most).astype(int).T)]
        x, y, z = lattice.bricks
        in_reach = reached.reshape(z, y, x).transpose(2, 1, 0)[tuple((cells * _SWEPT_SIDE // BRICK_SIDE).T)]
        mean = in_reach * (mean / max(mean.sum(), 1e-300) + _EVEN / max(np.count_nonzero(in_reach), 1))
        return cls._of_sums(mean.reshape(sums.shape), _SWEPT_SIDE, total, lattice)

    @classmethod
    def _of_sums(cls, sums: np.ndarray, side: int, total: np.ndarray, lattice: Lattice) -> "EmissionCells":
        """The cells, each chosen by its sum (x, y, z), whose sides have so many voxels."""
        while np.count_nonzero(sums) > _MOST_CELLS:
            sums, side = _halved(sums), 2 * side
        cells = np.stack(np.nonzero(sums), axis=1)
        x, y, z = (side * cells).T
        width, depth, _ = lattice.voxels
        records = np.stack([x + width * (y + depth * z), _starts(sums[tuple(cells.T)])], axis=1)
        return cls(records.astype(np.uint32), side, total)


def _brightness(emission: np.ndarray, lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
    """(x, y, z) mean of the channels of an emission by voxel, and the (3,) sums of the channels."""
    channels = [_within(lattice.in_order(emission[..., k : k + 1])[..., 0]) for k in range(3)]
    total = np.array([channel.sum(dtype=np.float64) for channel in channels])
    return (channels[0] + channels[1] + channels[2]) / 3.0, total


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
