# SPDX-License-Identifier: GPL-3.0-or-later
"""View of a viewport as a camera."""

import bpy
import numpy as np

from ....scene import Camera
from ....scene.errors import SceneError
from ..common.matrices import unscaled
from .camera import frame_shape, frame_size, window
from .lens import export_aperture, export_panorama

_PIXEL_SIZES = {"AUTO": 1, "1": 1, "2": 2, "4": 4, "8": 8}


def export_view(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> Camera:
    """The camera of the viewport that is being drawn: its frame is the region, its crop the render border.

    Raises SceneError where the border holds no pixel, or the scene's camera cannot be rendered or has no scale.
    """
    region, view, space = context.region, context.region_data, context.space_data
    coarseness = _PIXEL_SIZES.get(context.scene.render.preview_pixel_size, 1)
    width, height = (max(1, size // coarseness) for size in (region.width, region.height))
    try:
        matrix = unscaled(np.array(view.view_matrix.inverted(), np.float64))
    except ValueError:
        raise SceneError("the view has no direction, as its camera has a scale of 0; give it another scale") from None
    projection = np.array(view.window_matrix, np.float64)
    through_camera = view.view_perspective == "CAMERA" and space.camera is not None
    camera_object = space.camera.evaluated_get(depsgraph) if through_camera else None
    if camera_object is not None and camera_object.type != "CAMERA":
        camera_object = None  # Blender lets any object be looked through
    camera = None if camera_object is None else camera_object.data
    orthographic = not view.is_perspective
    edges = frame_edges(projection, orthographic)
    clipped = camera or space
    clip_start, clip_end = clipped.clip_start, clipped.clip_end
    if orthographic and camera is None:
        # Blender sees what lies behind the point of view as well: step back until all of it lies ahead.
        nearest = (projection[2, 3] + 1.0) / projection[2, 2]
        matrix[:3, 3] -= matrix[:3, 2] * nearest
        clip_start, clip_end = 0.0, (projection[2, 3] - 1.0) / projection[2, 2] - nearest
    frame = None if camera is None else _frame_in_view(context.scene, camera, edges)
    result = Camera(
        matrix=matrix,
        window=edges,
        width=width,
        height=height,
        orthographic=orthographic,
        clip_start=clip_start,
        clip_end=max(clip_end, clip_start * 1.001),
        crop=_crop(context, frame, width, height),
    )
    if camera is not None:
        result.aperture = export_aperture(camera, matrix, depsgraph)
        if camera.type == "PANO":
            across, upward = frame_shape(context.scene.render, *frame_size(context.scene.render))
            result.panorama = export_panorama(camera, camera_object.name, across, upward)
            result.window = _fractions_of_frame(frame, camera)
            result.orthographic = False
    return result


def frame_edges(projection: np.ndarray, orthographic: bool) -> tuple[float, float, float, float]:
    """left, right, bottom, top of a projection matrix (4, 4): tangents, or meters of an orthographic one."""
    edges = []
    for axis in (0, 1):
        shift = -projection[axis, 3] if orthographic else projection[axis, 2]
        edges += [float((side + shift) / projection[axis, axis]) for side in (-1.0, 1.0)]
    return tuple(edges)


def _frame_in_view(
    scene: bpy.types.Scene, camera: bpy.types.Camera, edges: tuple[float, float, float, float]
) -> tuple[float, float, float, float]:
    """left, right, bottom, top of the camera's frame in shares of the region."""
    shape = frame_shape(scene.render, *frame_size(scene.render))
    left, right, bottom, top = edges
    x_min, x_max, y_min, y_max = window(camera, *shape, flat=True)
    width, height = right - left, top - bottom
    return (x_min - left) / width, (x_max - left) / width, (y_min - bottom) / height, (y_max - bottom) / height


def _fractions_of_frame(
    frame: tuple[float, float, float, float], camera: bpy.types.Camera
) -> tuple[float, float, float, float]:
    """left, right, bottom, top of the region in shares of a panorama's frame."""
    x_min, x_max, y_min, y_max = frame
    x, y = camera.shift_x, camera.shift_y
    width, height = x_max - x_min, y_max - y_min
    return x - x_min / width, x + (1.0 - x_min) / width, y - y_min / height, y + (1.0 - y_min) / height


def _crop(
    context: bpy.types.Context, frame: tuple[float, float, float, float] | None, width: int, height: int
) -> tuple[int, int, int, int] | None:
    """Pixels of the render border: in the camera's view that of the scene, else that of the viewport."""
    source, border = (context.space_data, "render_border") if frame is None else (context.scene.render, "border")
    if not getattr(source, f"use_{border}"):
        return None
    x_min, x_max, y_min, y_max = (getattr(source, f"{border}_{edge}") for edge in ("min_x", "max_x", "min_y", "max_y"))
    if frame is not None:
        left, right, bottom, top = frame
        x_min, x_max = (left + x * (right - left) for x in (x_min, x_max))
        y_min, y_max = (bottom + y * (top - bottom) for y in (y_min, y_max))
    crop = (
        max(0, int(x_min * width)),
        max(0, int(y_min * height)),
        min(width, int(np.ceil(x_max * width))),
        min(height, int(np.ceil(y_max * height))),
    )
    if crop[0] >= crop[2] or crop[1] >= crop[3]:
        raise SceneError("the render border lies outside of the view; draw another or clear it (View > View Regions)")
    return crop
