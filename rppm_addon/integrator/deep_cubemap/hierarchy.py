# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchy of the deep cubemap's cells, divided level by level into tiles of 4 x 4 cells."""

from dataclasses import dataclass

import numpy as np

from .build_buffers import BuildBuffers
from .records import TILE_CELLS


@dataclass(frozen=True)
class Level:
    """A level of cells whose triangles are to be found."""

    number: int
    """0 is that of the roots."""
    first_tile: int
    end_tile: int
    """The level's tiles are those from the first up to this one."""
    job_count: int
    """Pairs of a triangle and a tile of the level that the triangle may touch."""
    side_exponent: int
    """Log2 of the cells along a face's side."""

    @property
    def resolution(self) -> int:
        """Cells along a face's side."""
        return 1 << self.side_exponent


class Hierarchy:
    """The cells of one build, down from the roots."""

    def __init__(self, buffers: BuildBuffers, parameters: np.void) -> None:
        """parameters: STATE, of which the root and base levels count."""
        self._buffers = buffers
        self._root_exponent = int(parameters["root_exponent"])
        root_count, base_level = int(parameters["root_count"]), int(parameters["base_level"])
        self._tiles_above_base = [root_count * 16**level for level in range(base_level)]
        """Tiles of each level above the base level, where all cells are divided."""
        self.fragment_count = 0
        """Fragments of all levels so far."""

    def initialize_base(self, parameters: np.void) -> None:
        """Begin a build with the parameters, a STATE, and divide the faces down to the base level."""
        state = parameters.copy()
        state["tile_count"] = sum(self._tiles_above_base)
        self._buffers.begin(state)
        self._buffers.run("initialize_base", int(state["tile_count"]))

    def base_level(self) -> Level:
        """Return the base level once its jobs are listed. Raises as BuildBuffers.read_complete_state does."""
        level = len(self._tiles_above_base)
        first_tile = sum(self._tiles_above_base[:-1])
        return self._level(level, first_tile, self._buffers.read_complete_state(level))

    def divide(self, level: Level) -> Level | None:
        """Divide the cells of a level that hold much, and propagate the fragments to lists, bins or the next level.

        Returns the next level; None where no cell is divided any more. Raises as BuildBuffers.read_complete_state does.
        """
        buffers = self._buffers
        state = buffers.read_complete_state(level.number)
        fragment_count = int(state["fragment_count"])
        self.fragment_count += fragment_count
        buffers.swap_fragments()
        state["job_count"] = state["fragment_count"] = state["reserved_count"] = 0
        buffers.state.upload(state)
        division = {
            "first_tile": level.first_tile,
            "end_tile": level.end_tile,
            "level": level.number,
            "side_exponent": level.side_exponent,
            "fragment_count": fragment_count,
            "tile_cells": TILE_CELLS,
        }
        buffers.run("divide", level.end_tile - level.first_tile, division)
        buffers.run("propagate", fragment_count, division)
        state = buffers.read_complete_state(level.number + 1)
        buffers.check_starts("entries", int(state["entry_count"]), level.number + 1)
        if int(state["tile_count"]) == level.end_tile:
            return None
        return self._level(level.number + 1, level.end_tile, state)

    def merge(self, last_level: Level) -> None:
        """Merge the depth ranges of tiles into the cells above, up to the roots, and record the last level."""
        for level in range(len(self._tiles_above_base) - 1, -1, -1):
            first, tiles = sum(self._tiles_above_base[:level]), self._tiles_above_base[level]
            cells = {"first_cell": first, "end_cell": first + tiles, "tile_cells": TILE_CELLS}
            self._buffers.run("merge_tiles", tiles, cells)
        state = self._buffers.read_state()
        state["last_level"] = last_level.number
        self._buffers.state.upload(state)

    def _level(self, number: int, first_tile: int, state: np.void) -> Level:
        side_exponent = self._root_exponent + 2 * number
        return Level(number, first_tile, int(state["tile_count"]), int(state["job_count"]), side_exponent)
