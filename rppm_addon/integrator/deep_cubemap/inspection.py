# SPDX-License-Identifier: GPL-3.0-or-later
"""Costs of the camera's rays in the deep cubemap, for the pass Deep Cubemap."""

import numpy as np

from ...gl.buffers.buffers import GrowingBuffer
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.camera import Camera
from ..common.band import bands_of
from ..common.camera_view import CAMERA_VIEW, camera_view
from .deep_cubemap import DeepCubemap


def inspect_deep_cubemap(
    context: Context, library: ProgramLibrary, deep_cubemap: DeepCubemap, camera: Camera
) -> np.ndarray:
    """(height, width, 4) float32: CUBEMAP_COSTS of the rays through the pixels' centers, row 0 at the bottom."""
    width, height = camera.resolution
    levels = {"CUBEMAP_LEVELS": 1} if deep_cubemap.has_instances else {}
    defines = {"COUNT_TRAVERSAL": 1, **levels, **deep_cubemap.traversal_defines}
    program = library.compute("deep_cubemap/inspect.comp", defines)
    view_buffer, result = GrowingBuffer(context, "camera"), GrowingBuffer(context, "inspection", "lower the resolution")
    picture = np.zeros((height, width, 4), np.float32)
    try:
        view_buffer.require(CAMERA_VIEW.size)
        for band in bands_of(width, height):
            view_buffer.upload(camera_view(camera, band.first_row, band.rows, (0.0, 0.0)))
            result.require(16 * band.pixel_count)
            buffers = {**deep_cubemap.traversal_buffers, "Camera": view_buffer.buffer, "Inspections": result.buffer}
            program.run(band.pixel_count, {name: buffers[name] for name in program.blocks})
            costs = result.read(np.float32, 4 * band.pixel_count).reshape(band.rows, width, 4)
            picture[band.first_row : band.first_row + band.rows] = costs
    finally:
        view_buffer.release()
        result.release()
    return picture
