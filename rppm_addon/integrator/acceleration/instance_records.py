# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of instances that rays place in the world."""

import numpy as np

from ...gl.buffers.buffers import GrowingBuffer
from ..common.affine import affine_inverses
from .acceleration_structure import MARGIN
from .instances import BOTTOM_LEVEL_INSTANCE, InstancedMeshes

_AT_ONCE = 1 << 16
"""Records that are made at a time, lest those of a million stand in memory at once."""
_NEAR = 256
"""Rows from one that has changed to the next, up to which those between are written again: few calls take less time."""


class InstanceRecords:
    """BOTTOM_LEVEL_INSTANCE records on the device, of which only those are written that have changed."""

    def __init__(self) -> None:
        self._instanced: InstancedMeshes | None = None
        self._roots = np.zeros(0, np.int64)
        self._reach = 0.0

    def take(self, instanced: InstancedMeshes, roots: np.ndarray, reach: float) -> np.ndarray | None:
        """Take instances; returns the rows that differ from those of the last time, or None where all may.

        roots: (meshes,) those of the meshes' structures; reach: how far from the world's origin anything is, meters.
        """
        before, self._instanced = self._instanced, None  # until they are written
        # A margin for half of the reach still leaves fifteen times the rounding error.
        has_margin = reach <= 2.0 * self._reach
        if before is not None and has_margin and np.array_equal(self._roots, roots) and instanced.has_rows_of(before):
            return instanced.changed_since(before)
        self._roots, self._reach = roots, reach
        return None

    def write(self, buffer: GrowingBuffer, instanced: InstancedMeshes, changed: np.ndarray | None) -> None:
        """Write the records of rows, ascending, or of all, at least one. Raises DeviceError."""
        count = len(instanced.which)
        if buffer.require_items(max(count, 1)) or changed is None:
            changed = np.arange(count)
            if not count:
                buffer.write(BOTTOM_LEVEL_INSTANCE.zeros(1))
        for rows in runs(changed, _AT_ONCE):
            records = instance_records(instanced, self._roots[instanced.which[rows]], self._reach, rows)
            buffer.write(records, int(rows[0]) * BOTTOM_LEVEL_INSTANCE.size)
        self._instanced = instanced


def runs(rows: np.ndarray, most: int) -> list[np.ndarray]:
    """Ascending rows in runs of rows that follow each other, of no more than ``most``: with those between rows that are
    near each other."""
    parts = np.split(rows, np.flatnonzero(np.diff(rows) > _NEAR) + 1) if len(rows) else []
    spans = [(int(part[0]), int(part[-1]) + 1) for part in parts]
    return [np.arange(start, min(start + most, end)) for first, end in spans for start in range(first, end, most)]


def instance_records(instanced: InstancedMeshes, roots: np.ndarray, reach: float, rows: np.ndarray) -> np.ndarray:
    """BOTTOM_LEVEL_INSTANCE records of rows of instances. roots: (n,) those of these; reach: how far from the world's
    origin anything is, meters."""
    records = BOTTOM_LEVEL_INSTANCE.zeros(len(rows))
    with np.errstate(invalid="ignore", over="ignore"):
        inverses, entries = affine_inverses(instanced.matrices[rows]), instanced.entries[rows]
    for row in range(3):
        records[f"to_object{row}"] = inverses[:, row]
        records[f"row{row}"] = entries[f"row{row}"]
    for name in ("pivot", "set_code", "first_slot", "slot_count"):
        records[name] = entries[name]
    records["first_triangle"] = instanced.mesh_first_triangles[instanced.which[rows]]
    records["root"] = roots
    records["placement"] = instanced.placements[rows]
    records["mirrored"] = instanced.are_mirrored[rows]
    # Rounding of a ray's origin, and of the vertices in the world.
    records["margin"] = MARGIN * reach * np.linalg.norm(inverses[:, :, :3], axis=(1, 2))
    return records
