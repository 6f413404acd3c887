# SPDX-License-Identifier: GPL-3.0-or-later
"""Buffers of the deep cubemap, which the steps of a build fill and grow."""

import logging
from collections.abc import Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.buffers import GrowingBuffer
from ...gl.context.context import TEXEL_SIZE, Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...scene.errors import DeviceError, DeviceLostError
from ..common.require import require
from .clusters import Clusters
from .records import BINNED_CELL, BINNED_FRAGMENT, CELL, FRAGMENT, STATE

log = logging.getLogger(__name__)

_MAX_ROOTS = 24
_CERTAIN_FRACTION = 0.8
"""Fraction of its expected length that a long list has at least."""
_MAX_STARTS = 1 << 26
"""Places of entries and bins that cells can name (shaders/deep_cubemap/cells.glsl)."""


class ListTooShortError(Exception):
    """A list did not hold everything, and has been grown: the build starts over."""


class LevelTooFineError(Exception):
    """A list that the cells of ``level`` need is longer than the device allows; ``cause`` says which."""

    def __init__(self, level: int, cause: DeviceError) -> None:
        self.level, self.cause = level, cause


class BuildBuffers(BufferSet):
    """State, cells and lists of a deep cubemap. They are kept between builds and grow with need.

    ``triangles``: the vertices of the triangles that are sorted, three vec4 each.
    """

    remedy = "lower the cubemap resolution or simplify the geometry"
    state = StorageBuffer("deep cubemap state", STATE, block="DeepCubemap")
    cells = StorageBuffer("deep cubemap cells", CELL, block="CubemapCells")
    bins = StorageBuffer("deep cubemap depth bins", "uint", block="DepthBins")
    _tiles = StorageBuffer("deep cubemap tiles", "uint", block="CubemapTiles")
    _jobs = StorageBuffer("deep cubemap jobs", "uvec4", texel_bytes=16, block="OverlapJobs")
    _fragments = StorageBuffer("deep cubemap fragments", FRAGMENT, texel_bytes=8)
    _fragments_above = StorageBuffer("deep cubemap fragments of the level above", FRAGMENT, texel_bytes=8)
    entries = StorageBuffer("deep cubemap entries", "uvec2", texel_bytes=8, block="CellEntries")
    _binned_cells = StorageBuffer("deep cubemap binned cells", BINNED_CELL, block="BinnedCells")
    _binned_fragments = StorageBuffer(
        "deep cubemap binned fragments", BINNED_FRAGMENT, texel_bytes=4, block="BinnedFragments"
    )
    core = StorageBuffer("deep cubemap core list", "uint", 16, block="CoreTriangles")
    boxes = StorageBuffer("boxes of instances", "vec4", texel_bytes=16, block="InstanceBoxes")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._context, self._library = context, library
        self.triangles: moderngl.Buffer | None = None
        self._new_fragments, self._old_fragments = self._fragments, self._fragments_above

    @property
    def _lists(self) -> dict[str, GrowingBuffer]:
        """Lists by the name of their count and capacity in the state."""
        return {
            "job": self._jobs,
            "fragment": self._new_fragments,
            "entry": self.entries,
            "binned_cell": self._binned_cells,
            "binned_fragment": self._binned_fragments,
            "core": self.core,
        }

    @property
    def blocks(self) -> dict[str, Bindable]:
        """BufferSet.blocks, with the triangles and the fragments of two levels."""
        return {
            **super().blocks,
            "Triangles": require(self.triangles),
            "NewFragments": self._new_fragments.buffer,
            "OldFragments": self._old_fragments.buffer,
        }

    def run(
        self,
        step: str,
        threads: int,
        parameters: Mapping[str, int] | None = None,
        defines: Mapping[str, object] | None = None,
    ) -> None:
        """Run the program of a step of the build, ``shaders/deep_cubemap/<step>.comp``, on these buffers."""
        self._library.compute(f"deep_cubemap/{step}.comp", defines).run(threads, self.blocks, parameters)

    def begin(self, state: np.void) -> None:
        """Upload the STATE that a build begins with, and the capacities of the lists with it."""
        state["tile_capacity"] = min((self.cells.capacity - _MAX_ROOTS) // 16, self._tiles.capacity)
        for name, buffer in self._lists.items():
            state[f"{name}_capacity"] = buffer.capacity
        state["fragment_limit"] = self._new_fragments.limit // FRAGMENT.size
        state["fragment_capacity"] = min(int(state["fragment_capacity"]), self._old_fragments.capacity)
        self.state.upload(state)

    def swap_fragments(self) -> None:
        """Take the new fragments as those of the level above."""
        self._new_fragments, self._old_fragments = self._old_fragments, self._new_fragments

    def read_state(self) -> np.void:
        """Return a copy of the STATE. Waits for the device."""
        return self.state.read(STATE.dtype, 1)[0].copy()

    def read_complete_state(self, level: int) -> np.void:
        """Return the STATE once the lists hold what the cells of a level need. Waits for the device.

        Raises ListTooShortError after it has grown the lists, and LevelTooFineError where the device does not allow
        that.
        """
        state = self.read_state()
        names = [name for name in ("tile", *self._lists) if state[f"{name}_count"] > state[f"{name}_capacity"]]
        for name in names:
            log.debug("deep cubemap: %d of %d %s", state[f"{name}_count"], state[f"{name}_capacity"], name)
            try:
                self._grow(name, int(state[f"{name}_count"]))
            except DeviceError as error:
                raise LevelTooFineError(level, error) from error
        if names:
            raise ListTooShortError
        return state

    def require_bins(self, count: int, level: int) -> None:
        """Make room for depth bins, and empty them. Raises LevelTooFineError where there is none."""
        self.check_starts("depth bins", count, level)
        try:
            self.bins.require_items(count)
        except DeviceError as error:
            raise LevelTooFineError(level, error) from error
        self.bins.clear()

    def check_starts(self, name: str, count: int, level: int) -> None:
        """Raise LevelTooFineError where the cells of a level have more items, such as entries, than they can name."""
        if count > _MAX_STARTS:
            error = DeviceError(f"{count} {name} of cells are more than {_MAX_STARTS}; {self.remedy}")
            raise LevelTooFineError(level, error)

    def reserve(self, triangle_count: int, clusters: Clusters) -> None:
        """Make room for an ordinary scene of so many triangles, as far as the device allows it.

        A list is longer than a storage block only where it certainly must be, which saves builds in vain.
        """
        limit = self._context.storage_block_limit
        for name, expected in expected_lengths(triangle_count, clusters.list_length).items():
            size = 16 * CELL.size if name == "tile" else self._lists[name].item_size
            block_items = limit // size - 2
            if name != "tile" and _CERTAIN_FRACTION * expected > block_items:
                try:
                    self._grow(name, min(expected, self._lists[name].limit // size - 2))
                except DeviceLostError:
                    raise
                except DeviceError as error:
                    log.debug("%s", error)  # coarser cells may do with fewer
            self._grow(name, min(expected, block_items))

    def _grow(self, name: str, count: int) -> None:
        """Make room for ``count`` items of a list, with some to spare where the device allows it."""
        limit = self._context.storage_block_limit
        if name != "tile" and count * self._lists[name].item_size > limit:
            limit = self._lists[name].limit

        def room(number: int, spacious: int) -> int:
            return -(-max(number, min(spacious, limit)) // TEXEL_SIZE) * TEXEL_SIZE

        spacious = count + count // 4
        if name == "tile":
            self._tiles.require(room(4 * count, 4 * spacious))
            self.cells.require(room(CELL.size * (_MAX_ROOTS + 16 * count), CELL.size * (_MAX_ROOTS + 16 * spacious)))
            return
        buffer = self._lists[name]
        if count > buffer.capacity:
            buffer.require(room(count * buffer.item_size, spacious * buffer.item_size))
        if name == "fragment":
            self._old_fragments.require(buffer.size)


def expected_lengths(triangle_count: int, list_length: float) -> dict[str, int]:
    """Return the lengths of lists that ordinary scenes of so many triangles stay below.

    ``list_length``: length relative to lists without clusters.
    """
    number = int(list_length * triangle_count)
    return {
        "job": 5 * number // 2 + 4096,
        "fragment": 4 * number + 16384,
        "tile": number // 32 + 4096,
        "entry": 7 * number + 16384,
        "binned_cell": number // 4 + 4096,
        "binned_fragment": 5 * number + 16384,
    }
