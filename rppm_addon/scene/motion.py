# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion of a scene's members while the shutter is open."""

from dataclasses import dataclass, field

import numpy as np

from .common.declared import declared


@dataclass
class Movement:
    """The way of an instance or a light."""

    member: int
    """Index into Scene.instances or Scene.lights."""
    times: np.ndarray = field(metadata=declared("keys"))
    """(keys,) float64, ascending from 0, when the shutter opens, to 1, when it closes."""
    matrices: np.ndarray = field(metadata=declared("keys", 4, 4))
    """(keys, 4, 4) float64, object to world."""


@dataclass
class Deformation:
    """The shapes of a mesh, whose corners and triangles stay."""

    mesh: int = field(metadata=declared(below="meshes"))
    """Index into Scene.meshes."""
    times: np.ndarray = field(metadata=declared("keys"))
    """(keys,) float64, as those of a Movement."""
    positions: np.ndarray = field(metadata=declared("keys", "vertices", 3, types="float32"))
    """(keys, vertices, 3) float32, meters."""
    corner_normals: np.ndarray = field(metadata=declared("keys", "corners", 3, types="float32"))
    """(keys, corners, 3) float32, unit."""


@dataclass
class CameraMovement:
    """The way of the camera, and how it zooms."""

    times: np.ndarray = field(metadata=declared("keys"))
    """(keys,) float64, as those of a Movement."""
    matrices: np.ndarray = field(metadata=declared("keys", 4, 4))
    """(keys, 4, 4) float64, camera to world."""
    windows: np.ndarray = field(metadata=declared("keys", 4))
    """(keys, 4) float64, as Camera.window."""


@dataclass
class Shutter:
    """Motion of a scene's members while its picture is taken. The scene holds them as they are in the middle."""

    curve: np.ndarray = field(metadata=declared("shares", finite=False))
    """(n,) float64, 0 or more: how far the shutter is open in each nth of its time."""
    instances: list[Movement] = field(default_factory=list)
    lights: list[Movement] = field(default_factory=list)
    meshes: list[Deformation] = field(default_factory=list)
    camera: CameraMovement | None = None
    rolling_duration: float = field(default=1.0, metadata=declared(minimum=0.0, maximum=1.0))
    """Part of the time in which each row is exposed by a rolling shutter, one after the other from the top. 1 exposes
    all rows together."""

    @property
    def is_rolling(self) -> bool:
        """True where rows are exposed one after the other."""
        return self.rolling_duration < 1.0

    def time_of(self, fraction: float) -> float:
        """The time, 0 to 1, by which a fraction of all the light that the shutter lets pass has passed. Of a rolling
        shutter, whose curve is that of each row, the times of all rows together: they are as long."""
        if self.is_rolling:
            return fraction
        weights = np.maximum(np.nan_to_num(self.curve), 0.0)
        passed = np.concatenate([[0.0], np.cumsum(weights)])
        if passed[-1] <= 0.0:
            return fraction
        return float(np.interp(fraction * passed[-1], passed, np.linspace(0.0, 1.0, len(passed))))
