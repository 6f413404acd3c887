# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocities of volumes, which blur them."""

from dataclasses import dataclass

import bpy
import numpy as np

from .....scene.volumes import VolumeGrid, VolumeMotion
from ..meshes.meshes import FARTHEST


@dataclass(frozen=True)
class VelocityBlur:
    """The time in which velocities move the values of volumes while the shutter is open."""

    seconds: float
    """Time that the shutter is open."""
    rest_time: float
    """When values are where the grids have them: VolumeMotion.rest_time."""

    @classmethod
    def of(cls, render: bpy.types.RenderSettings) -> "VelocityBlur":
        """The time of a render with Motion Blur.

        As in Cycles, values go on from where their frame has them when the shutter opens at Start on Frame. At End on
        Frame they have already gone on for the part of a frame for which the shutter is closed.
        """
        shutter = render.motion_blur_shutter
        rest_time = {"START": 0.0, "CENTER": 0.5, "END": shutter - 1.0}[render.motion_blur_position]
        return cls(shutter * render.fps_base / render.fps, rest_time)

    def motion(self, velocities: VolumeGrid, scale: float, by_second: bool = True) -> VolumeMotion | None:
        """The motion that velocities (x, y, z, 3) make; None where nothing moves.

        scale: their factor. by_second: whether they are meters a second; else, as in Cycles, they are meters in the
        time of the shutter, however long it is.
        """
        ways = velocities.values * np.float32(scale * (self.seconds if by_second else 1.0))
        ways = np.where(np.abs(ways) < FARTHEST, ways, np.float32(0.0))
        return VolumeMotion(VolumeGrid(ways, velocities.matrix), self.rest_time) if ways.any() else None


def merged(components: list[VolumeGrid]) -> VolumeGrid | None:
    """The velocities whose components along x, y and z are grids (x, y, z, 1) of their own; None where the voxels of
    one are others."""
    to_indices = np.linalg.pinv(components[0].matrix)
    places = [to_indices @ grid.matrix for grid in components]
    starts = np.array([np.rint(place[:3, 3]) for place in places]).astype(int)
    if not all(
        np.allclose(place[:3, :3], np.eye(3), atol=1e-4) and np.allclose(place[:3, 3], start, atol=1e-2)
        for place, start in zip(places, starts, strict=True)
    ):
        return None
    counts = np.array([grid.values.shape[:3] for grid in components])
    low = starts.min(axis=0)
    values = np.zeros((*((starts + counts).max(axis=0) - low), 3), np.float32)
    for axis, (grid, start, count) in enumerate(zip(components, starts - low, counts, strict=True)):
        i, j, k = (slice(first, first + length) for first, length in zip(start, count, strict=True))
        values[i, j, k, axis] = grid.values[..., 0]
    matrix = components[0].matrix.copy()
    matrix[:3, 3] += matrix[:3, :3] @ low
    return VolumeGrid(values, matrix)
