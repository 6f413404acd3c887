# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's camera to a window in front of a camera without scale."""

import bpy
import numpy as np

from ....scene import Camera
from ....scene.errors import SceneError
from ..common.matrices import unscaled
from ..common.report import Report
from .eyes import Eye
from .lens import export_aperture, export_panorama
from .stand_in import StandInCamera, camera_data

_SINGLE = Eye()
_NOTHING = 1e-6
"""Where a camera clips what it sees on both sides that sees nothing but the world, meters."""


def export_camera(
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph,
    used: bpy.types.Object | None = None,
    eye: Eye = _SINGLE,
    report: Report | None = None,
) -> Camera:
    """The scene's active camera, or the one that is used in its place, as evaluated in the depsgraph.

    eye: of the view that is rendered. report: takes a warning where the camera sees the world only.
    Raises SceneError when there is no camera that can be used.
    """
    used = used or eye.camera_of(scene)
    if used is None:
        raise SceneError("the scene has no camera; add one, or make one active with Scene properties > Camera")
    camera_object = used.evaluated_get(depsgraph)
    camera = camera_data(camera_object)
    if camera.type == "CUSTOM" and report is not None:
        report.warn(
            f'Camera "{camera_object.name}": the code of its lens (Open Shading Language) is not run, and the picture '
            "is in perspective, with the camera's focal length; choose another lens type, or render with Cycles"
        )
    if camera.type not in {"PERSP", "ORTHO", "PANO", "CUSTOM"}:
        raise SceneError(
            f'camera "{camera_object.name}" is of type {camera.type}, which RPPM cannot render; '
            "set its lens type to Perspective, Orthographic or Panoramic"
        )
    matrix, is_blind = _pose(camera_object, eye, report)
    width, height = frame_size(scene.render)
    across, upward = frame_shape(scene.render, width, height)
    panoramic = camera.type == "PANO"
    return Camera(
        matrix=matrix,
        window=window(camera, across, upward, eye.shift_of(camera_object)),
        width=width,
        height=height,
        orthographic=camera.type == "ORTHO",
        clip_start=_NOTHING if is_blind else camera.clip_start,
        clip_end=_NOTHING if is_blind else max(camera.clip_end, camera.clip_start * 1.001),
        crop=crop(scene.render, width, height),
        panorama=export_panorama(camera, camera_object.name, across, upward) if panoramic else None,
        aperture=export_aperture(camera, matrix, depsgraph),
        stereo=eye.stereo_of(camera_object),
    )


def _pose(camera_object: bpy.types.Object, eye: Eye, report: Report | None) -> tuple[np.ndarray, bool]:
    """The matrix (4, 4) of a camera without scale, and whether it sees the world only, as in Cycles if its scale is 0.

    Raises SceneError where its matrix is not finite.
    """
    given, name = eye.matrix_of(camera_object), camera_object.name
    if not np.isfinite(given).all():
        raise SceneError(f'the matrix of camera "{name}" is not finite; correct its transform and that of its parents')
    try:
        return unscaled(given), False
    except ValueError:
        matrix = np.eye(4)
        matrix[:3, 3] = given[:3, 3]
    if report is not None:
        report.warn(
            f'Camera "{name}": as in Cycles it sees the world only, as its scale is 0; give it and its parents a scale'
        )
    return matrix, True


def camera_pose(
    camera_object: bpy.types.Object, render: bpy.types.RenderSettings, eye: Eye
) -> tuple[np.ndarray, tuple[float, float, float, float]] | None:
    """Matrix and window of an evaluated camera object that export_camera takes; None where it sees nothing."""
    try:
        matrix = unscaled(eye.matrix_of(camera_object))
    except ValueError:
        return None
    return matrix, window(
        camera_data(camera_object), *frame_shape(render, *frame_size(render)), eye.shift_of(camera_object)
    )


def frame_size(render: bpy.types.RenderSettings) -> tuple[int, int]:
    """Pixels of the whole frame: the resolution, scaled by its percentage."""
    return tuple(
        max(1, int(size * render.resolution_percentage / 100)) for size in (render.resolution_x, render.resolution_y)
    )


def frame_shape(render: bpy.types.RenderSettings, width: int, height: int) -> tuple[float, float]:
    """Sizes of the frame in units of a pixel's width: pixels may not be square."""
    return float(width), height * render.pixel_aspect_y / render.pixel_aspect_x


def window(
    camera: bpy.types.Camera | StandInCamera,
    across: float,
    upward: float,
    shift_x: float | None = None,
    flat: bool = False,
) -> tuple[float, float, float, float]:
    """left, right, bottom, top: tangents for a perspective camera, meters for an orthographic one, shares of a
    panorama's frame, which is ``across`` by ``upward`` pixel widths. shift_x: in place of the camera's own. flat: of a
    panorama, those of the perspective view that Blender draws of it."""
    shift_x = camera.shift_x if shift_x is None else shift_x
    if camera.type == "PANO" and not flat:
        return shift_x, shift_x + 1.0, camera.shift_y, camera.shift_y + 1.0
    fit = camera.sensor_fit
    if fit == "AUTO":
        fit = "HORIZONTAL" if across >= upward else "VERTICAL"
    fitted = across if fit == "HORIZONTAL" else upward
    if camera.type == "ORTHO":
        size = camera.ortho_scale
    else:
        # With automatic fit the sensor's width is laid along the longer side, whichever it is.
        sensor = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
        size = sensor / camera.lens
    half_width, half_height = 0.5 * size * across / fitted, 0.5 * size * upward / fitted
    # Shifts are in units of the fitted side.
    x, y = shift_x * size, camera.shift_y * size
    return x - half_width, x + half_width, y - half_height, y + half_height


def crop(render: bpy.types.RenderSettings, width: int, height: int) -> tuple[int, int, int, int] | None:
    """Pixels of the render border, x_min, y_min, x_max, y_max; None when the whole frame is rendered.

    Raises SceneError when the border holds no pixel.
    """
    if not render.use_border:
        return None
    # Blender cuts the border's edges down to whole pixels in single precision.
    edges = np.float32([render.border_min_x, render.border_min_y, render.border_max_x, render.border_max_y])
    x_min, y_min, x_max, y_max = (edges * np.float32([width, height, width, height])).astype(int).tolist()
    if x_max <= x_min or y_max <= y_min:
        raise SceneError("the render border holds no pixel; draw a larger one or clear it (View > View Regions)")
    return x_min, y_min, x_max, y_max
