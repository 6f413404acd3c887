# SPDX-License-Identifier: GPL-3.0-or-later
"""The deep cubemap read back and decoded with NumPy, apart from the shaders' code."""

from dataclasses import dataclass

import numpy as np

from rppm_addon.integrator.deep_cubemap import CELL, STATE, DeepCubemap


@dataclass
class Structure:
    """``entries`` columns: cell, bin, triangle, continued, least and greatest 16-bit depth."""

    state: np.void
    cells: np.ndarray
    entries: np.ndarray
    bin_counts: np.ndarray  # per finest cell

    @property
    def near(self) -> np.ndarray:
        return (~self.cells["near_complement"]).view(np.float32)

    @property
    def far(self) -> np.ndarray:
        return self.cells["far"].view(np.float32)


def read_structure(cubemap: DeepCubemap) -> Structure:
    buffers = cubemap.traversal_buffers
    state = np.frombuffer(buffers["DeepCubemap"].read(STATE.size), STATE.dtype)[0]
    cells = np.frombuffer(buffers["CubemapCells"].read(), CELL.dtype)
    finest = cells[: 6 * cubemap.resolution**2]
    bin_ends = np.frombuffer(buffers["DepthBins"].read(), np.uint32)
    packed = np.frombuffer(buffers["CellEntries"].read(8 * int(state["entry_count"])), np.uint32).reshape(-1, 2)
    full = np.flatnonzero(finest["slices"])
    packed_bins = finest["bins"][full].astype(np.int64)
    starts, counts = packed_bins >> 4, 1 << (packed_bins & 15)
    bin_counts = np.zeros(len(finest), np.int64)
    bin_counts[full] = counts
    # a row for each bin of each full cell
    row_cell = np.repeat(full, counts)
    row_bin = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    first = bin_ends[np.repeat(starts, counts) + row_bin].astype(np.int64)
    end = bin_ends[np.repeat(starts, counts) + row_bin + 1].astype(np.int64)
    length = end - first
    place = np.repeat(first - (np.cumsum(length) - length), length) + np.arange(length.sum())
    taken = np.bincount(place, minlength=len(packed))
    assert np.all(length >= 0) and np.all(taken == 1), "the lists must share out the entries without overlap"
    entry = packed[place]
    columns = (
        np.repeat(row_cell, length),
        np.repeat(row_bin, length),
        entry[:, 0] & 0x7FFFFFFF,
        entry[:, 0] >> 31,
        entry[:, 1] & 0xFFFF,
        entry[:, 1] >> 16,
    )
    return Structure(state, cells, np.stack([c.astype(np.int64) for c in columns], 1), bin_counts)


def locate(points: np.ndarray, resolution: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Face, (n, 2) cell and depth of points about the centre."""
    index = np.arange(len(points))
    axis = np.abs(points).argmax(1)
    face = 2 * axis + (points[index, axis] < 0)
    depth = np.abs(points[index, axis])
    lateral = np.stack([points[index, (axis + 1) % 3], points[index, (axis + 2) % 3]], 1)
    cell = np.floor((lateral / depth[:, None] * 0.5 + 0.5) * resolution)
    return face, np.clip(cell, 0, resolution - 1).astype(np.int64), depth


def block_indices(face: np.ndarray, cell: np.ndarray, resolution: int) -> list[np.ndarray]:
    """Where a cell and the blocks around it are stored, finest first."""
    indices = []
    start, side, level = 0, resolution, 0
    while side >= 1:
        x, y = cell[:, 0] >> (2 * level), cell[:, 1] >> (2 * level)
        indices.append(start + (face * side + y) * side + x)
        start += 6 * resolution**2 if level == 0 else 6 * (resolution // 4) ** 2
        side //= 4
        level += 1
    return indices
