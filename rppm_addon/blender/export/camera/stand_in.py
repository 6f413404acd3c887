# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera that Cycles makes of an object of another kind, as Blender lets a scene be seen through any object."""

import math
from dataclasses import dataclass, field
from types import SimpleNamespace

import bpy

_SPOT_SIZE = 0.25 * math.pi
"""Radians of a new light; Blender does not give the angle of lights that are no spots."""


@dataclass(frozen=True)
class StandInCamera:
    """Properties that are read of a bpy.types.Camera, with the values of Cycles (blender/camera.cpp, BlenderCamera)."""

    lens: float = 50.0
    """Millimeters."""
    type: str = "PERSP"
    sensor_fit: str = "AUTO"
    sensor_width: float = 36.0
    sensor_height: float = 24.0
    shift_x: float = 0.0
    shift_y: float = 0.0
    clip_start: float = 1e-5
    clip_end: float = 1e5
    dof: SimpleNamespace = field(default_factory=lambda: SimpleNamespace(use_dof=False))


def camera_data(used: bpy.types.Object) -> bpy.types.Camera | StandInCamera:
    """The camera of an object: its own, the cone of a light, or a lens of 50 mm."""
    if used.type == "CAMERA":
        return used.data
    if used.type == "LIGHT":
        lens = 16.0 / math.tan(0.5 * getattr(used.data, "spot_size", _SPOT_SIZE))
        if lens > 0.0:
            return StandInCamera(lens)
    return StandInCamera()
