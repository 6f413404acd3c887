# SPDX-License-Identifier: GPL-3.0-or-later
"""A look at the deep cubemap: what the camera's rays cost in it."""

import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..scene.camera import Camera
from .bands import bands_of
from .camera_view import camera_view
from .deep_cubemap import DeepCubemap
from .records import CAMERA_VIEW


def inspect_deep_cubemap(
    context: Context, library: ProgramLibrary, deep_cubemap: DeepCubemap, camera: Camera
) -> np.ndarray:
    """(height, width, 4) float32: CUBEMAP_COSTS of the rays through the pixels' centres, row 0 at the bottom."""
    width, height = camera.resolution
    program = library.compute("deep_cubemap/inspect.comp", {"DEEP_CUBEMAP_COUNT": 1})
    view_buffer, result = GrowingBuffer(context, "camera"), GrowingBuffer(context, "inspection", "lower the resolution")
    picture = np.zeros((height, width, 4), np.float32)
    try:
        view_buffer.require(CAMERA_VIEW.size)
        for first_row, rows in bands_of(width, height):
            view_buffer.upload(camera_view(camera, first_row, rows, (0.0, 0.0)))
            result.require(16 * width * rows)
            buffers = {**deep_cubemap.traversal_buffers, "Camera": view_buffer.buffer, "Inspections": result.buffer}
            program.run(width * rows, {name: buffers[name] for name in program.blocks})
            picture[first_row : first_row + rows] = result.read(np.float32, 4 * width * rows).reshape(rows, width, 4)
    finally:
        view_buffer.release()
        result.release()
    return picture
