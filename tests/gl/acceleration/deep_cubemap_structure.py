# SPDX-License-Identifier: GPL-3.0-or-later
"""The deep cubemap read back and decoded with NumPy, apart from the shaders' code."""

from dataclasses import dataclass

import numpy as np

from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap
from rppm_addon.integrator.deep_cubemap.records import CELL, MAX_JOIN, STATE, CellKind

LIST, BINS, TILE = CellKind
BEFORE, BEHIND = 2, 1
"""Marks of entries whose triangle is in the bin before or behind, too."""


@dataclass
class Structure:
    """All cells from the roots down, level by level, and all entries.

    ``face``, ``level``, ``x``, ``y``: places of the cells, x and y of 2^(root_exponent + 2 level) a side.
    ``children``: (n, 16) rows of a divided cell's children, x first; -1 for other cells.
    ``bin_counts``: 0 but for cells of kind BINS; ``kind``: -1 for empty cells.
    ``entries`` columns: row of the cell, bin, triangle, marks, least and greatest 16-bit depth.
    """

    state: np.void
    cells: np.ndarray
    face: np.ndarray
    level: np.ndarray
    x: np.ndarray
    y: np.ndarray
    kind: np.ndarray
    children: np.ndarray
    bin_counts: np.ndarray
    entries: np.ndarray

    @property
    def near(self) -> np.ndarray:
        """Codes of depths (int64)."""
        return (~self.cells["near_complement"]).astype(np.int64)

    @property
    def far(self) -> np.ndarray:
        return self.cells["far"].astype(np.int64)

    @property
    def root_side(self) -> int:
        return 1 << int(self.state["root_exponent"])

    def codes(self, depths: np.ndarray) -> np.ndarray:
        """Codes of depths (float64, meters): the bits of the float, clamped to half of the core's radius."""
        least = np.float32(0.5) * self.state["core_radius"]
        return np.maximum(depths.astype(np.float32), least).view(np.uint32).astype(np.int64)

    def parts(self, rows: np.ndarray, codes: np.ndarray, number: np.ndarray | int) -> np.ndarray:
        """Which of a ``number`` of equal parts of their cells' depth ranges codes lie in."""
        near, far = self.near[rows], self.far[rows]
        scale = np.float32(number) / np.maximum(far - near, 1).astype(np.float32)
        offset = (np.clip(codes, near, far) - near).astype(np.float32)
        return np.minimum((offset * scale).astype(np.int64), np.asarray(number) - 1)

    def bins(self, rows: np.ndarray, codes: np.ndarray) -> np.ndarray:
        """The bins of codes whose slices are in use, for cells of kind BINS."""
        exponent = (self.cells["content"][rows] & 15).astype(np.int64)
        cut, join = np.maximum(exponent - MAX_JOIN, 0), np.maximum(MAX_JOIN - exponent, 0)
        part = self.parts(rows, codes, 32 << cut)
        piece = part >> cut
        used_before = bit_count(self.cells["slices"][rows].astype(np.int64) & ((1 << piece) - 1))
        return ((used_before << cut) + (part & ((1 << cut) - 1))) >> join

    def rows_of(self, points: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
        """Rows of the cells that points about the center lie in, by level from the roots down, and their depths.

        Beyond a point's leaf the row is -1.
        """
        index = np.arange(len(points))
        axis = np.abs(points).argmax(1)
        face = 2 * axis + (points[index, axis] < 0)
        depth = np.abs(points[index, axis])
        lateral = np.stack([points[index, (axis + 1) % 3], points[index, (axis + 2) % 3]], 1)
        position = lateral / depth[:, None] * 0.5 + 0.5

        def place(side: int) -> np.ndarray:
            return np.clip(np.floor(position * side), 0, side - 1).astype(np.int64)

        side = self.root_side
        cell = place(side)
        rows = [(face * side + cell[:, 1]) * side + cell[:, 0]]
        for _ in range(int(self.level.max())):
            side *= 4
            cell = place(side)
            above = rows[-1]
            offset = (cell[:, 1] & 3) << 2 | (cell[:, 0] & 3)
            rows.append(np.where(above < 0, -1, self.children[above, offset]))
        return rows, depth


def bit_count(values: np.ndarray) -> np.ndarray:
    """Bits set in the lower 32 bits of int64."""
    return np.unpackbits(values.astype("<u4").view(np.uint8).reshape(-1, 4), axis=1).sum(1).astype(np.int64)


def read_structure(cubemap: DeepCubemap) -> Structure:
    buffers = cubemap.traversal_buffers
    state = np.frombuffer(buffers["DeepCubemap"].read(STATE.size), STATE.dtype)[0]
    stored = np.frombuffer(buffers["CubemapCells"].read(), CELL.dtype)
    bin_ends = np.frombuffer(buffers["DepthBins"].read(), np.uint32).astype(np.int64)
    packed = np.frombuffer(buffers["CellEntries"].read(8 * int(state["entry_count"])), np.uint32).reshape(-1, 2)

    side = 1 << int(state["root_exponent"])
    assert state["root_count"] == 6 * side * side
    place = np.arange(6 * side * side)
    face, y, x = place // (side * side), place // side % side, place % side
    levels, children, first_row = [], [], 0
    while len(place):
        content = stored["content"][place]
        levels.append((place, face, np.full(len(place), len(levels)), x, y))
        first_row += len(place)
        divided = np.flatnonzero(content >> 30 == TILE)
        below = np.full((len(place), 16), -1)
        below[divided] = first_row + np.arange(16 * len(divided)).reshape(-1, 16)
        children.append(below)
        child = np.arange(16)
        place = ((content[divided] & 0x3FFFFFFF).astype(np.int64)[:, None] + child).ravel()
        face = np.repeat(face[divided], 16)
        x = (4 * x[divided][:, None] + (child & 3)).ravel()
        y = (4 * y[divided][:, None] + (child >> 2)).ravel()
    place, face, level, x, y = (np.concatenate(column) for column in zip(*levels))
    # each tile divides one cell
    assert len(np.unique(place)) == len(place) == state["root_count"] + 16 * state["tile_count"]
    cells = stored[place]

    content = cells["content"].astype(np.int64)
    kind = np.where(content == 0, -1, content >> 30)
    start, count = (content & 0x3FFFFFFF) >> 4, content & 15
    listed, binned = np.flatnonzero(kind == LIST), np.flatnonzero(kind == BINS)
    # the slices in use, joined or cut
    slices = bit_count(cells["slices"])
    cut, join = np.maximum(count - MAX_JOIN, 0), np.maximum(MAX_JOIN - count, 0)
    bin_counts = np.where(kind == BINS, (((slices << cut) - 1) >> join) + 1, 0)

    # a row for each list and each bin
    bins = bin_counts[binned]
    number = np.arange(bins.sum()) - np.repeat(np.cumsum(bins) - bins, bins)
    place_of_bin = np.repeat(start[binned], bins) + number
    list_row = np.concatenate([listed, np.repeat(binned, bins)])
    list_bin = np.concatenate([np.zeros(len(listed), np.int64), number])
    first = np.concatenate([start[listed], bin_ends[place_of_bin]])
    length = np.concatenate([count[listed], bin_ends[place_of_bin + 1] - bin_ends[place_of_bin]])
    assert np.all(length >= 0) and np.all(count[listed] > 0)
    entry_place = np.repeat(first - (np.cumsum(length) - length), length) + np.arange(length.sum())
    taken = np.bincount(entry_place, minlength=len(packed))
    assert len(taken) == len(packed) and np.all(taken == 1), "the lists must share out the entries without overlap"
    entry = packed[entry_place]
    columns = np.repeat(list_row, length), np.repeat(list_bin, length), entry[:, 0] & 0x3FFFFFFF, entry[:, 0] >> 30
    columns += entry[:, 1] & 0xFFFF, entry[:, 1] >> 16
    entries = np.stack([c.astype(np.int64) for c in columns], 1)
    return Structure(state, cells, face, level, x, y, kind, np.concatenate(children), bin_counts, entries)


def as_sets(structure: Structure) -> tuple[np.ndarray, np.ndarray]:
    """Return what does not depend on the order of allocation: two structures are the same if these are equal.

    A row a cell: level, face, y, x, kind, bins, near, far, slices; and a row an entry: the first four of its cell,
    then the other columns. Both are sorted.
    """
    place = np.stack([structure.level, structure.face, structure.y, structure.x], 1)
    values = [structure.kind, structure.bin_counts, structure.near, structure.far, structure.cells["slices"]]
    cells = np.concatenate([place, np.stack([v.astype(np.int64) for v in values], 1)], 1)
    entries = np.concatenate([place[structure.entries[:, 0]], structure.entries[:, 1:]], 1)
    return cells[np.lexsort(cells.T)], entries[np.lexsort(entries.T)]
