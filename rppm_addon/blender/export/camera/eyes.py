# SPDX-License-Identifier: GPL-3.0-or-later
"""Position and shift of a render's camera with stereo and multiview."""

import bpy
import numpy as np

from ....scene import SphericalStereo
from .stand_in import camera_data


class Eye:
    """Where cameras stand, and how far they are shifted, for the view that an engine is rendering.

    Objects that are no cameras have no two eyes: Blender would crash if asked for those.
    """

    def __init__(self, engine: bpy.types.RenderEngine | None = None) -> None:
        """engine: None, or one whose render has a single view, takes cameras as they are."""
        has_views = engine is not None and not engine.is_preview and engine.render.use_multiview
        self._engine = engine if has_views else None

    def camera_of(self, scene: bpy.types.Scene) -> bpy.types.Object | None:
        """The camera that the view is seen by: with multiview each may have its own."""
        return scene.camera if self._engine is None else self._engine.camera_override or scene.camera

    def matrix_of(self, camera: bpy.types.Object) -> np.ndarray:
        """(4, 4) float64, camera to world."""
        is_plain = self._engine is None or camera.type != "CAMERA"
        if is_plain:
            return np.array(camera.matrix_world, np.float64)
        is_spherical = self._is_spherical(camera)
        return np.array(self._engine.camera_model_matrix(camera, use_spherical_stereo=is_spherical), np.float64)

    def shift_of(self, camera: bpy.types.Object) -> float:
        """To the right, as Blender has it."""
        if self._engine is None or camera.type != "CAMERA":
            return camera_data(camera).shift_x
        return self._engine.camera_shift_x(camera, use_spherical_stereo=self._is_spherical(camera))

    def stereo_of(self, camera: bpy.types.Object) -> SphericalStereo | None:
        """The eye of an evaluated camera with spherical stereo; None for other cameras."""
        if self._engine is None or camera.type != "CAMERA" or not self._is_spherical(camera):
            return None
        side = _SIDES.get(self._engine.active_view_get(), 0.0)
        stereo = camera.data.stereo
        is_parallel = stereo.convergence_mode == "PARALLEL"
        merge = stereo.pole_merge_angle_from, stereo.pole_merge_angle_to
        return SphericalStereo(
            offset=0.5 * side * stereo.interocular_distance,
            convergence_distance=None if is_parallel else stereo.convergence_distance,
            pole_merge=merge if stereo.use_pole_merge else None,
        )

    def _is_spherical(self, camera: bpy.types.Object) -> bool:
        return bool(self._engine is not None and self._engine.use_spherical_stereo(camera))


_SIDES = {"left": -1.0, "right": 1.0}
"""By view, the side of its eye."""


def views_of(engine: bpy.types.RenderEngine, layer: str) -> list[str]:
    """The names of the views that a view layer is rendered in; "" is the only one without multiview."""
    if engine.is_preview or not engine.render.use_multiview:
        return [""]
    result = engine.begin_result(0, 0, 1, 1, layer=layer)
    names = list(result.views.keys())
    engine.end_result(result, cancel=True)
    return names
