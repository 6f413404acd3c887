# SPDX-License-Identifier: GPL-3.0-or-later
"""Coefficients of media on lattices of voxels, stored as sparse bricks of half floats."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...gl.buffers.constants import Constants

BRICK_SIDE = 8
"""Voxels along a side of a brick."""
BRICK_VOXELS = BRICK_SIDE**3
_NO_CHANNEL, _THREE_CHANNELS, _FIRST_CHANNEL_MASK = 0xFF, 0x40, 0x3F
"""Codes of the channels of a coefficient: none, a flag beside the number of the first of three, and the bits of that
number."""
Constants(
    "VoxelBricks",
    BRICK_SIDE=BRICK_SIDE,
    BRICK_VOXELS=BRICK_VOXELS,
    NO_CHANNEL=_NO_CHANNEL,
    THREE_CHANNELS=_THREE_CHANNELS,
    FIRST_CHANNEL_MASK=_FIRST_CHANNEL_MASK,
)
_ALIKE = 2e-3
"""Relative error up to which the colors of voxels count as one color times a density; half floats have 5e-4."""
_NOTHING = 1e-6
"""Fraction of the largest coefficient below which the color of a voxel does not matter."""
_LARGEST = 1e12
"""Largest coefficient, 1/m."""


@dataclass(frozen=True)
class Lattice:
    """Voxels whose centers reach from one corner of a box to the opposite one."""

    voxels: tuple[int, int, int]
    """At least two along each axis."""
    low: np.ndarray
    """(3,) center of the first voxel, meters in the space of the object."""
    spacing: np.ndarray
    """(3,) distances between centers, meters."""

    @classmethod
    def of(cls, low: np.ndarray, high: np.ndarray, spacing: float | np.ndarray, most: int) -> "Lattice":
        """The lattice of a box whose voxels are at most ``spacing`` wide, unless there would be more than ``most``."""
        size = np.maximum(np.asarray(high, np.float64) - low, 0.0)
        size = np.maximum(size, max(1e-6 * float(size.max()), 1e-9))
        steps = np.maximum(size / np.maximum(spacing, 1e-9), 1.0)
        if np.prod(steps + 1.0) > most:
            lowest, highest = 1.0, float(steps.max())
            for _ in range(60):
                middle = 0.5 * (lowest + highest)
                if np.prod(np.maximum(steps / middle, 1.0) + 1.0) > most:
                    lowest = middle
                else:
                    highest = middle
            steps = np.floor(np.maximum(steps / highest, 1.0) + 1e-6)
        counts = np.ceil(steps - 1e-3).astype(int) + 1
        x, y, z = (int(count) for count in counts)
        return cls((x, y, z), np.asarray(low, np.float64), size / (counts - 1))

    @property
    def bricks(self) -> tuple[int, int, int]:
        """Bricks along each axis."""
        x, y, z = (-(-count // BRICK_SIDE) for count in self.voxels)
        return x, y, z

    @property
    def to_grid(self) -> np.ndarray:
        """(4, 4) matrix from the object to the grid, in which voxel i reaches from i to i + 1."""
        matrix = np.diag([*(1.0 / self.spacing), 1.0])
        matrix[:3, 3] = 0.5 - self.low / self.spacing
        return matrix

    def in_order(self, values: np.ndarray) -> np.ndarray:
        """Values (bricks, BRICK_VOXELS, channels) as (x, y, z, channels), as the voxels lie."""
        x, y, z = self.bricks
        blocks = values.reshape(z, y, x, BRICK_SIDE, BRICK_SIDE, BRICK_SIDE, -1)
        ordered = blocks.transpose(2, 5, 1, 4, 0, 3, 6)
        ordered = ordered.reshape(x * BRICK_SIDE, y * BRICK_SIDE, z * BRICK_SIDE, -1)
        return ordered[: self.voxels[0], : self.voxels[1], : self.voxels[2]]


@dataclass(frozen=True)
class BrickGrid:
    """Words of a medium in MediumVoxels (shaders/media/grid.glsl), and what its record says of them."""

    words: np.ndarray
    """(n,) uint32: the table of bricks, with places counted from the first word or 0, and the voxels of the bricks."""
    table_size: int
    """Bricks of the table."""
    channel_count: int
    """Numbers of each voxel."""
    channels: int
    """Codes of the channels of absorption, scattering and emission, a byte each from the lowest."""
    scales: np.ndarray
    """(3, 3) float32 factors of the three coefficients."""

    def words_at(self, first: int) -> np.ndarray:
        """(n,) uint32 words with places counted from the start of the buffer, for words that begin at ``first``."""
        words = self.words.copy()
        table = words[: self.table_size]
        table[table > 0] += np.uint32(first)
        return words


def usable(values: np.ndarray) -> np.ndarray:
    """Coefficients as they can be rendered: finite and not negative."""
    return np.clip(np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0), 0.0, _LARGEST)


def brick_grid(coefficients: Sequence[np.ndarray | None], kept: np.ndarray | None = None) -> BrickGrid:
    """Store absorption, scattering and emission, each (bricks, BRICK_VOXELS, 3) float32 or None for none.

    A coefficient that is a density times one color takes one channel, which another of the same density shares.
    kept: (bricks,) bool, bricks that are stored without effect as well.
    """
    channels: list[np.ndarray] = []
    codes, scales = [], np.zeros((3, 3), np.float32)
    for index, values in enumerate(coefficients):
        if values is None or not values.any():
            codes.append(_NO_CHANNEL)
            continue
        density = _density(values)
        if density is None:
            scales[index] = values.max()
            codes.append(len(channels) | _THREE_CHANNELS)
            channels += [values[..., channel] / scales[index, 0] for channel in range(3)]
            continue
        field, scales[index] = density
        same = next((number for number, other in enumerate(channels) if _are_alike(field, other)), len(channels))
        codes.append(same)
        if same == len(channels):
            channels.append(field)
    bricks = next((len(values) for values in coefficients if values is not None), 1)
    packed = sum(code << 8 * place for place, code in enumerate(codes))
    return BrickGrid(*_words(channels, bricks, kept), len(channels), packed, scales)


def _density(values: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """(bricks, BRICK_VOXELS) float32 density, 1 where it is largest, and the (3,) color that it scales; None where
    the values are of several colors."""
    flat = values.reshape(-1, 3)
    color = flat[flat.sum(axis=1).argmax()].astype(np.float64)
    field = (flat @ (color / (color @ color)).astype(np.float32)).astype(np.float32)
    largest = color.max()
    for channel in range(3):
        error = np.abs(flat[:, channel] - field * np.float32(color[channel]))
        if (error > largest * (_ALIKE * field + _NOTHING)).any():
            return None
    return field.reshape(values.shape[:2]), color


def _are_alike(field: np.ndarray, other: np.ndarray) -> bool:
    return not (np.abs(field - other) > _ALIKE * other + _NOTHING).any()


def _words(channels: list[np.ndarray], bricks: int, kept: np.ndarray | None) -> tuple[np.ndarray, int]:
    """Words of channels, each (bricks, BRICK_VOXELS), and the length of their table."""
    table = np.zeros(bricks, np.uint32)
    if not channels:
        return table, bricks
    halves = np.stack([channel.astype("<f2") for channel in channels], axis=1)
    has_effect = halves.reshape(bricks, -1).any(axis=1)
    filled = np.flatnonzero(has_effect if kept is None else has_effect | kept)
    table[filled] = bricks + np.arange(len(filled)) * (len(channels) * BRICK_VOXELS // 2)
    return np.concatenate([table, np.ascontiguousarray(halves[filled]).reshape(-1).view("<u4")]), bricks
