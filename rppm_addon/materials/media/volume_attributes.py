# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes that the nodes of a volume read: grids of voxels, or values that an object has as a whole."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.volumes import Volume, VolumeGrid

VOLUME_GRID_ENTRY = Record(
    "VolumeGridEntry",
    to_grid0="vec4",
    to_grid1="vec4",
    to_grid2="vec4",
    voxels="uvec3",
    first_value="uint",
    components="uint",
)
"""A grid of voxels as an attribute: the rows of the matrix from object space to the indices of voxels, and the place
and the number of its values; no components: the object has no such attribute."""


class VolumeAttributes(BufferSet):
    """The buffers VolumeGrids and VolumeValues (shaders/materials/volume_grids.glsl), for one object at a time."""

    remedy = "use smaller grids in volumes"
    _grids = StorageBuffer("grids of a volume", VOLUME_GRID_ENTRY, block="VolumeGrids")
    _values = StorageBuffer("values of a volume", "float", texel_bytes=16, block="VolumeValues")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._uploaded: tuple[object, ...] = ()

    def upload(self, names: Sequence[str], volume: Volume | None, whole: Mapping[str, tuple[float, ...]]) -> None:
        """Hold the attributes of an object by their names. whole: values of those that it has as a whole."""
        if self._uploaded and self._uploaded[0] is volume and self._uploaded[1:] == (list(names), dict(whole)):
            return
        self._uploaded = ()  # should an upload fail
        grids = {} if volume is None else volume.grids
        self.upload_grids([_even_grid(whole[name]) if name in whole else grids.get(name) for name in names])
        self._uploaded = volume, list(names), dict(whole)

    def upload_grids(self, grids: Sequence[VolumeGrid | None]) -> None:
        """Hold grids by their numbers; None: an object has none."""
        entries = VOLUME_GRID_ENTRY.zeros(max(len(grids), 1))
        parts, end = [np.zeros(1, np.float32)], 1
        for entry, grid in zip(entries, grids, strict=False):
            if grid is None or not grid.values.size:
                continue
            matrix = np.linalg.pinv(np.asarray(grid.matrix, np.float64))
            for row in range(3):
                entry[f"to_grid{row}"] = matrix[row]
            entry["voxels"], entry["components"] = grid.values.shape[:3], grid.values.shape[3]
            entry["first_value"] = end
            parts.append(np.nan_to_num(grid.values, nan=0.0, posinf=0.0, neginf=0.0).ravel())
            end += grid.values.size
        self._grids.upload(entries)
        self._values.upload(np.concatenate(parts))


def _even_grid(value: tuple[float, ...]) -> VolumeGrid:
    """One voxel that all places lie in."""
    matrix = np.zeros((4, 4))
    matrix[3, 3] = 1.0
    return VolumeGrid(np.array(value, np.float32).reshape(1, 1, 1, -1), matrix)
