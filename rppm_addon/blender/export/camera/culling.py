# SPDX-License-Identifier: GPL-3.0-or-later
"""Culling of Simplify: objects that ask for it are left out where the camera does not see them, or from afar."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ....scene import Camera


class Culling:
    """Which objects a final render leaves out, by their boxes, as Cycles has it (BlenderObjectCulling)."""

    def __init__(self, scene: bpy.types.Scene | None = None, camera: Camera | None = None) -> None:
        """Take the settings of an evaluated scene and the camera that looks at it. Without them nothing is left out."""
        self._by_camera = self._by_distance = False
        self._boxes: dict[tuple[int, int], tuple[np.ndarray, bool, bool] | None] = {}
        """By the addresses of an original object and its data, the corners (8, 3) of the box, and by what it is
        culled."""
        if scene is None or camera is None or camera.panorama is not None:
            return
        settings = getattr(scene, "cycles", None)
        if settings is None or not scene.render.use_simplify or scene.render.use_multiview:
            return
        self._distance, self._margin = settings.distance_cull_margin, settings.camera_cull_margin
        self._by_camera = settings.use_camera_cull
        self._by_distance = settings.use_distance_cull and self._distance > 0.0
        self._camera, self._to_camera = camera, np.linalg.inv(camera.matrix)

    @property
    def is_used(self) -> bool:
        """Whether anything may be left out."""
        return self._by_camera or self._by_distance

    @property
    def state(self) -> tuple[Any, ...]:
        """Values that are equal where unchanged objects are culled as before; empty where nothing is left out."""
        if not self.is_used:
            return ()
        camera = self._camera
        place = camera.matrix.tobytes(), camera.window, camera.orthographic, camera.clip_start, camera.clip_end
        return self._by_camera, self._by_distance, self._distance, self._margin, *place

    def leaves_out(self, source: bpy.types.Object, matrix: np.ndarray) -> bool:
        """Whether an evaluated object is left out where a matrix (4, 4) places it."""
        if not self.is_used or source.type == "LIGHT":
            return False
        data = source.data  # of what nodes of geometry multiply, its own
        key = source.original.as_pointer(), 0 if data is None else data.as_pointer()
        if key not in self._boxes:
            self._boxes[key] = self._box(source)
        known = self._boxes[key]
        if known is None:
            return False
        box, by_camera, by_distance = known
        corners = box @ matrix[:3, :3].T + matrix[:3, 3]
        return (not by_camera or self._is_outside(corners)) and (not by_distance or self._is_far(corners))

    def _box(self, source: bpy.types.Object) -> tuple[np.ndarray, bool, bool] | None:
        by_camera = self._by_camera and source.cycles.use_camera_cull
        by_distance = self._by_distance and source.cycles.use_distance_cull
        if not (by_camera or by_distance):
            return None
        return np.array([tuple(corner) for corner in source.bound_box]), by_camera, by_distance

    def _is_outside(self, corners: np.ndarray) -> bool:
        """Return whether corners lie beyond an edge of the frame by more than the margin, a fraction of the frame."""
        camera = self._camera
        x, y, z = (corners @ self._to_camera[:3, :3].T + self._to_camera[:3, 3]).T
        left, right, bottom, top = camera.window
        start, end = camera.clip_start, camera.clip_end
        ahead = -z
        if camera.orthographic:
            depth, scale = (ahead - start) / (end - start), np.ones(8)
        else:
            depth = (ahead - start) * end / (end - start)
            scale = 1.0 / np.where(ahead != 0.0, ahead, 1e-12)
        if (depth < -self._margin).all():
            return True
        shares = np.stack([(x * scale - left) / (right - left), (y * scale - bottom) / (top - bottom)])
        shares = np.where(depth < 0.0, 1.0 - shares, shares)
        return bool((shares.min(axis=1) >= 1.0 + self._margin).any() or (shares.max(axis=1) <= -self._margin).any())

    def _is_far(self, corners: np.ndarray) -> bool:
        place = self._camera.matrix[:3, 3]
        nearest = np.clip(place, corners.min(axis=0), corners.max(axis=0))
        return bool(np.linalg.norm(nearest - place) > self._distance)


@dataclass(frozen=True)
class Selection:
    """The objects that an export renders: shown in the viewport, and not culled."""

    culling: Culling
    shown: Callable[[bpy.types.Object], bool] | None = None
    """Function that returns whether the viewport shows an original object; None if all objects are shown."""

    def shows(self, original: bpy.types.Object) -> bool:
        """Return whether the viewport or the render shows an original object, culling aside."""
        return self.shown is None or self.shown(original)
