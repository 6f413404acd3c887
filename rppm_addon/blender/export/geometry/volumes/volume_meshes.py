# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes as boxes around the voxels of their grids."""

from dataclasses import dataclass

import bpy
import numpy as np

from .....scene import Mesh, Volume, VolumeGrid
from .....scene.storage.sharing import keep_equal
from ...common.report import Report
from ..meshes.meshes import NO_MESH
from .gas_domains import read_gas
from .vdb_files import VolumeError, read_grids

_MIDDLE = (0.5, 0.5, 0.5)
"""Location and size of a texture space in which generated coordinates equal object coordinates, as in Cycles."""
_FACES = np.array([(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)])
"""Faces of a box that look outward, by its corners in the order of x, y and z from the lowest bit."""


@dataclass(frozen=True)
class GridSource:
    """An evaluated volume object, or a mesh object that is the domain of gas."""

    source: bpy.types.Object

    @property
    def is_gas(self) -> bool:
        """True for a fluid domain of gas, False for a volume object."""
        return self.source.type == "MESH"

    def as_pointer(self) -> int:
        """Return the address of the object's data, which tells it from others in memory."""
        return self.source.data.as_pointer()


def export_grids(data: GridSource, name: str, report: Report, before: Mesh | None) -> Mesh | None:
    """The box around the grids of a volume, in its object's space; None where they are empty.

    before: what it may resemble; arrays that are the same are its very arrays.
    """
    try:
        grids, messages = (read_gas(data.source), []) if data.is_gas else read_grids(data.source.data)
    except VolumeError as error:
        report.warn(f'Object "{name}": {error}. It is left out')
        return None
    for message in messages:
        report.warn(f'Object "{name}": {message}')
    if not grids:
        return None
    before = before or NO_MESH
    is_in_object = not data.is_gas and data.source.data.render.space == "OBJECT"
    volume = Volume(grids, is_in_object)
    places = np.concatenate([_corners(grid) for grid in grids.values()])
    low, high = places.min(axis=0), places.max(axis=0)
    corners = np.array([[(low, high)[number >> axis & 1][axis] for axis in range(3)] for number in range(8)])
    texture = (
        (data.source.data.texspace_location[:], data.source.data.texspace_size[:])
        if data.is_gas
        else (
            _MIDDLE,
            _MIDDLE,
        )
    )
    triangles = np.concatenate([4 * np.arange(6)[:, None] + [0, 1, 2], 4 * np.arange(6)[:, None] + [0, 2, 3]])
    return Mesh(
        name,
        keep_equal(before.positions, corners.astype(np.float32)),
        keep_equal(before.corner_vertices, _FACES.reshape(-1).astype(np.int32)),
        keep_equal(before.corner_normals, np.zeros((24, 3), np.float32)),
        keep_equal(before.triangle_corners, triangles.astype(np.int32)),
        keep_equal(before.triangle_slots, np.zeros(12, np.int32)),
        texture_location=tuple(texture[0]),
        texture_size=tuple(texture[1]),
        volume=volume,
    )


def _corners(grid: VolumeGrid) -> np.ndarray:
    """(8, 3) places of the outermost voxels of a grid."""
    last = np.array(grid.values.shape[:3]) - 1
    indices = np.array([[last[axis] * (number >> axis & 1) for axis in range(3)] for number in range(8)])
    return indices @ grid.matrix[:3, :3].T + grid.matrix[:3, 3]
