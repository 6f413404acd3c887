# SPDX-License-Identifier: GPL-3.0-or-later
"""Advection of the voxels of media along the velocities of their volumes, for motion blur."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...gl.buffer_sets import BufferSet, Part, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...scene.volumes import VolumeMotion
from .bricks import BRICK_SIDE, BRICK_VOXELS, BrickGrid, Lattice
from .volume_attributes import VolumeAttributes

Record(
    "AdvectVoxelsParameters",
    low="vec3",
    time="float",
    spacing="vec3",
    count="uint",
    voxels="uvec3",
    channels="uint",
    volume="uint",
    first_resting="uint",
    first_moved="uint",
    first_brick="uint",
)
_WORDS = BRICK_VOXELS // 2
"""Words of a channel in a brick."""
_BLOCK = 4
"""Voxels of velocities along a side of the blocks that are looked for together."""


@dataclass(frozen=True)
class MovingGrid:
    """A grid of bricks whose values move."""

    grid: BrickGrid
    """At rest, with all bricks to which values come."""
    lattice: Lattice
    motion: VolumeMotion

    @property
    def bricks(self) -> np.ndarray:
        """(n,) uint32 numbers of the bricks that are stored, in their order."""
        return np.flatnonzero(self.grid.words[: self.grid.table_size]).astype(np.uint32)


def reached_bricks(filled: np.ndarray, lattice: Lattice, motion: VolumeMotion) -> np.ndarray:
    """(bricks,) bool: bricks to which values of the ``filled`` ones, (bricks,) bool, come while the shutter is open."""
    x, y, z = lattice.bricks
    reached = filled.reshape(z, y, x)
    down, up = (way / (lattice.spacing * BRICK_SIDE) for way in motion.reach)
    for axis, steps in ((2, 0), (1, 1), (0, 2)):
        # A voxel is interpolated between neighbors, which may lie in the brick beside.
        reached = _spread(reached, axis, int(np.ceil(up[steps])) + 1, int(np.ceil(-down[steps])) + 1)
    return (reached & _moving_bricks(lattice, motion)).reshape(-1) | filled


def _spread(values: np.ndarray, axis: int, up: int, down: int) -> np.ndarray:
    """Booleans that are true where any is, from ``up`` places before to ``down`` places behind along an axis."""
    size = values.shape[axis]
    counts = np.cumsum(np.moveaxis(values, axis, 0), axis=0, dtype=np.int64)
    counts = np.concatenate([np.zeros((1, *counts.shape[1:]), np.int64), counts])
    places = np.arange(size)
    found = counts[np.minimum(places + min(down, size) + 1, size)] - counts[np.maximum(places - min(up, size), 0)]
    return np.moveaxis(found > 0, 0, axis)


def _moving_bricks(lattice: Lattice, motion: VolumeMotion) -> np.ndarray:
    """(z, y, x) bool: bricks that velocities reach, with those around."""
    x, y, z = lattice.bricks
    found = np.zeros((z, y, x), bool)
    matrix, moves = motion.displacements.matrix, motion.displacements.values.any(axis=3)
    moves = np.pad(moves, [(0, -count % _BLOCK) for count in moves.shape])
    i, j, k = (count // _BLOCK for count in moves.shape)
    blocks = np.argwhere(moves.reshape(i, _BLOCK, j, _BLOCK, k, _BLOCK).any(axis=(1, 3, 5)))
    places = (_BLOCK * blocks + 0.5 * (_BLOCK - 1)) @ matrix[:3, :3].T + matrix[:3, 3]
    # A velocity is interpolated as far as the neighbors of its voxel.
    extent = 0.5 * (_BLOCK + 1) * np.abs(matrix[:3, :3]).sum(axis=1)
    low, high = ((places + way - lattice.low) / lattice.spacing / BRICK_SIDE for way in (-extent, extent))
    counts = np.array([x, y, z])
    low, high = (np.clip(np.floor(bounds), -1, counts).astype(int) for bounds in (low, high))
    spans = np.unique(np.concatenate([low, high], axis=1), axis=0)
    for first, last in zip(spans[:, :3], spans[:, 3:], strict=True):
        along_x, along_y, along_z = (slice(max(a, 0), b + 1) for a, b in zip(first, last, strict=True))
        found[along_z, along_y, along_x] = True
    return found


class VoxelAdvection(BufferSet):
    """Writes the voxels of grids that move into the buffer MediumVoxels, as they are at a time."""

    remedy = "use smaller or fewer volumes with velocities"
    _resting = StorageBuffer("resting voxels of media", "uint", texel_bytes=4, block="RestingVoxels")
    _bricks = StorageBuffer("bricks of moving media", "uint", block="MovingBricks")
    _displacements = Part(VolumeAttributes)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._library = library
        self._moving: list[MovingGrid] = []

    def upload(self, moving: list[MovingGrid]) -> None:
        """Hold grids at rest; those that it holds already stay."""
        if list(map(id, moving)) == list(map(id, self._moving)):
            return
        self._moving = []  # should an upload fail
        end, parts = 1, [np.zeros(1, np.uint32)]
        for each in moving:
            parts.append(each.grid.words_at(end))
            end += len(parts[-1])
        self._resting.upload(np.concatenate(parts))
        self._bricks.upload(np.concatenate([*(each.bricks for each in moving), np.zeros(1, np.uint32)]))
        self._displacements.upload_grids([each.motion.displacements for each in moving])
        self._moving = moving

    def run(self, time: float, firsts: list[int], voxels: Bindable) -> None:
        """Write the voxels at a time of the shutter, 0 to 1. firsts: where the words of each grid begin in the buffer
        ``voxels``."""
        if not self._moving:
            return
        program = self._library.compute("materials/advect_voxels.comp")
        blocks: Mapping[str, Bindable] = {**self.blocks, "MovedVoxels": voxels}
        first_resting, first_brick = 1, 0
        for number, (each, first) in enumerate(zip(self._moving, firsts, strict=True)):
            bricks = len(each.bricks)
            parameters = {
                "low": each.lattice.low, "time": time - each.motion.rest_time, "spacing": each.lattice.spacing,
                "count": bricks * _WORDS, "voxels": each.lattice.voxels, "channels": each.grid.channel_count,
                "volume": number, "first_resting": first_resting, "first_moved": first + each.grid.table_size,
                "first_brick": first_brick,
            }  # fmt: skip
            program.run(bricks * _WORDS, blocks, parameters)
            first_resting, first_brick = first_resting + len(each.grid.words), first_brick + bricks
