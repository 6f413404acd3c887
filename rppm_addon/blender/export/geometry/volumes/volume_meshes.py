# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes as boxes around the voxels of their grids."""

from dataclasses import dataclass

import bpy
import numpy as np

from .....scene import Mesh, Volume, VolumeGrid, VolumeMotion
from .....scene.storage.sharing import keep_equal
from ...common.report import Report
from ..meshes.meshes import NO_MESH
from .gas_domains import read_gas, read_gas_velocities
from .vdb_files import VolumeError, read_grids
from .velocities import VelocityBlur

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

    @property
    def is_blurred(self) -> bool:
        """True where the object's Motion Blur is on."""
        return getattr(getattr(self.source, "cycles", None), "use_motion_blur", True)

    def read(self, blur: VelocityBlur | None, report: Report, name: str) -> Volume | None:
        """The volume with its motion; None where it is empty, or cannot be read, as a warning then says.

        blur: None where velocities do not matter. name: that of the object.
        """
        blur = blur if self.is_blurred else None
        if self.is_gas:
            grids = read_gas(self.source)
            velocities, scale = read_gas_velocities(self.source) if grids and blur is not None else (None, 1.0)
            motion = None if blur is None or velocities is None else blur.motion(velocities, scale)
            return Volume(grids, motion=motion) if grids else None
        data = self.source.data
        try:
            file = read_grids(data, blur is not None)
        except VolumeError as error:
            report.warn(f'Object "{name}": {error}. It is left out')
            return None
        for message in file.messages:
            report.warn(f'Object "{name}": {message}')
        motion = None
        if blur is not None and file.velocities is not None:
            motion = blur.motion(file.velocities, data.velocity_scale, data.velocity_unit == "SECOND")
        return Volume(file.grids, data.render.space == "OBJECT", motion) if file.grids else None


def export_grids(
    data: GridSource, name: str, report: Report, before: Mesh | None, blur: VelocityBlur | None = None
) -> Mesh | None:
    """The box around the grids of a volume and where its velocities bring them, in its object's space; None where they
    are empty.

    before: what it may resemble; arrays that are the same are its very arrays. blur: None where velocities do not
    matter.
    """
    volume = data.read(blur, report, name)
    if volume is None:
        return None
    before = before or NO_MESH
    places = np.concatenate([_corners(grid) for grid in volume.grids.values()])
    low, high = places.min(axis=0), places.max(axis=0)
    if volume.motion is not None:
        low, high = _swept(low, high, volume.motion, volume.spacing)
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


def _swept(
    low: np.ndarray, high: np.ndarray, motion: VolumeMotion, spacing: np.ndarray | None
) -> tuple[np.ndarray, np.ndarray]:
    """A box around voxels, larger by as many voxels as these move, but no further than there are velocities."""
    if spacing is None:
        return low, high
    ends = _corners(motion.displacements)
    down, up = motion.reach
    lowest, highest = (np.maximum(low + down, ends.min(axis=0)), np.minimum(high + up, ends.max(axis=0)))
    steps_down, steps_up = np.ceil((low - lowest) / spacing), np.ceil((highest - high) / spacing)
    return low - np.maximum(steps_down, 0.0) * spacing, high + np.maximum(steps_up, 0.0) * spacing


def _corners(grid: VolumeGrid) -> np.ndarray:
    """(8, 3) places of the outermost voxels of a grid."""
    last = np.array(grid.values.shape[:3]) - 1
    indices = np.array([[last[axis] * (number >> axis & 1) for axis in range(3)] for number in range(8)])
    return indices @ grid.matrix[:3, :3].T + grid.matrix[:3, 3]
