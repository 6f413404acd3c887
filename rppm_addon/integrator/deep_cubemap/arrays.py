# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays that several deep cubemaps share, the parts of one behind those of another."""

from typing import Protocol

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.buffers import GrowingBuffer
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from .bottom_levels import MAX_LISTED
from .records import CELL


class CubemapSource(Protocol):
    """Buffers that hold a cubemap, from places that its STATE names on."""

    @property
    def cells(self) -> GrowingBuffer:
        """Cells, CELL records."""

    @property
    def entries(self) -> GrowingBuffer:
        """Entries of cells, uvec2."""

    @property
    def bins(self) -> GrowingBuffer:
        """Ends of depth bins, uint."""

    @property
    def core(self) -> GrowingBuffer:
        """Core list, uint."""


_NO_ITEMS = 0, 0, MAX_LISTED
"""Ends of the arrays without any cubemap."""


class CubemapArrays(BufferSet):
    """Cells, entries, and depth bins and core lists. Lists begin with the numbers from 0 on, the core list of each mesh
    that has no cells."""

    remedy = "lower the cubemap resolution or simplify the geometry"
    cells = StorageBuffer("deep cubemap cells of two levels", CELL, texel_bytes=16, block="CubemapCells")
    entries = StorageBuffer("deep cubemap entries of two levels", "uvec2", texel_bytes=8, block="CellEntries")
    lists = StorageBuffer("deep cubemap lists of two levels", "uint", block="DepthBins")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._context = context
        self._ends = list(_NO_ITEMS)

    @property
    def ends(self) -> tuple[int, ...]:
        """Items in use, of cells, entries and lists."""
        return tuple(self._ends)

    @property
    def bins(self) -> GrowingBuffer:
        """Depth bins, which are among the lists."""
        return self.lists

    @property
    def core(self) -> GrowingBuffer:
        """Core lists, which are among the lists."""
        return self.lists

    def cut(self, ends: tuple[int, ...] | None) -> None:
        """Drop what lies behind such ends; all where there are none."""
        self._ends = list(ends or _NO_ITEMS)

    def append(self, source: CubemapSource, state: np.void) -> np.void:
        """Copy a cubemap behind the others; returns its STATE, which names the places. Raises DeviceError."""
        if not self.lists.size:
            self.lists.upload(np.arange(MAX_LISTED, dtype=np.uint32))
        placed = state.copy()
        if not state["root_count"]:
            return placed  # a list
        parts = (
            ("first_cell", source.cells, 0, state["root_count"] + 16 * state["tile_count"]),
            ("first_entry", source.entries, 1, state["entry_count"]),
            ("first_bin", source.bins, 2, state["bin_count"]),
            ("first_core", source.core, 2, state["core_count"]),
        )
        for name, buffer, array, count in parts:
            placed[name] = self._copy(buffer, int(state[name]), array, int(count))
        return placed

    def _copy(self, source: GrowingBuffer, start: int, array: int, count: int) -> int:
        """Copy items of a buffer behind those of an array, by its place among the three; returns where they begin."""
        target = (self.cells, self.entries, self.lists)[array]
        first = self._ends[array]
        target.extend_items(max(first + count, 1))
        if count:
            size = target.item_size
            copied: moderngl.Buffer = source.buffer
            self._context.moderngl.copy_buffer(target.buffer, copied, size * count, size * start, size * first)
        self._ends[array] = first + count
        return first
