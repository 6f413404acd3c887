# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits: the camera's first hits by rasterization, in bands of rows."""

import math

import moderngl
import numpy as np

from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..scene.camera import Camera
from ..scene.errors import SceneError
from .geometry import Geometry
from .records import CAMERA_VIEW

MAXIMUM_BAND_PIXELS = 1 << 18
"""Pixels of a band: bounds the memory of camera paths and the length of one dispatch."""


def bands_of(width: int, height: int) -> list[tuple[int, int]]:
    """First row and rows of each band of a width x height region."""
    rows = max(1, min(height, MAXIMUM_BAND_PIXELS // width))
    return [(first, min(rows, height - first)) for first in range(0, height, rows)]


def filter_offsets(iteration: int, width: float, seed: int) -> tuple[float, float]:
    """Subpixel offset of an iteration (from 1), in pixels, by the density of a Blackman-Harris
    filter, along the R2 sequence (Roberts 2018) from a start of the seed's own.

    The filter reaches over twice its width, as Cycles' does (measured).
    """
    x = np.linspace(-0.5, 0.5, 1025)
    density = (
        0.35875 + 0.48829 * np.cos(2 * np.pi * x) + 0.14128 * np.cos(4 * np.pi * x) + 0.01168 * np.cos(6 * np.pi * x)
    )
    cumulated = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    g = 1.32471795724474602596
    start = np.random.default_rng(seed).random(2)
    u = (start + iteration / np.array([g, g**2])) % 1.0
    return tuple(float(2.0 * width * np.interp(value, cumulated / cumulated[-1], x)) for value in u)


def camera_view(camera: Camera, first_row: int, rows: int, offset: tuple[float, float]) -> np.ndarray:
    """CAMERA_VIEW record of a band of the camera's region, shifted by a subpixel offset.

    Raises SceneError when the camera's matrix, window or clip range cannot be used.
    """
    left, right, bottom, top = camera.window
    pixel_width, pixel_height = (right - left) / camera.width, (top - bottom) / camera.height
    if not (
        np.isfinite(camera.matrix).all()
        and math.isfinite(pixel_width * pixel_height)
        and pixel_width * pixel_height > 0
    ):
        raise SceneError("the camera's matrix or lens is not finite or has no extent; reset its transform and lens")
    x_min, y_min, x_max, _ = camera.region
    x0 = left + pixel_width * (x_min + offset[0])
    y0 = bottom + pixel_height * (y_min + first_row + offset[1])
    view = CAMERA_VIEW.zeros(1)
    axes = camera.matrix[:3, :3] / np.linalg.norm(camera.matrix[:3, :3], axis=0)
    view["position"], view["right"], view["up"], view["forward"] = (
        camera.matrix[:3, 3],
        axes[:, 0],
        axes[:, 1],
        -axes[:, 2],
    )
    view["orthographic"] = camera.orthographic
    start = camera.clip_start if camera.orthographic else max(camera.clip_start, 1e-6)
    view["clip_start"], view["clip_end"] = start, max(camera.clip_end, start * (1 + 1e-3) + 1e-6)
    view["pixel_solid_angle"] = pixel_width * pixel_height
    view["window"] = x0, x0 + pixel_width * (x_max - x_min), y0, y0 + pixel_height * rows
    view["width"], view["height"] = x_max - x_min, rows
    return view


class GBuffer:
    """A visibility buffer of one band: the nearest triangle of each pixel."""

    def __init__(self, context: Context, library: ProgramLibrary, width: int, rows: int) -> None:
        gl = context.moderngl
        self._draw = library.draw("gbuffer/visibility.vert", "gbuffer/visibility.frag")
        self._hits = library.compute("gbuffer/hits.comp")
        self._visibility = gl.texture((width, rows), 2, dtype="f4")
        self._visibility.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._depth = gl.depth_texture((width, rows))
        self._framebuffer = gl.framebuffer([self._visibility], self._depth)
        self.camera = gl.buffer(reserve=CAMERA_VIEW.size)

    @property
    def memory_bytes(self) -> int:
        return 12 * self._visibility.width * self._visibility.height

    def run(
        self, geometry: Geometry, view: np.ndarray, rays: moderngl.Buffer, hits: moderngl.Buffer, paths: moderngl.Buffer
    ) -> None:
        """First rays, hits and camera paths of the band that ``view`` (CAMERA_VIEW) describes."""
        self.camera.write(view.tobytes())
        width, rows = int(view["width"][0]), int(view["height"][0])
        self._framebuffer.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        self._draw.draw(
            self._framebuffer,
            3 * geometry.triangle_count,
            {"Camera": self.camera, "Triangles": geometry.triangles.buffer},
            viewport=(0, 0, width, rows),
            state=moderngl.DEPTH_TEST,
        )
        self._visibility.use(0)
        self._hits.run(
            width * rows,
            {
                "Camera": self.camera,
                "Triangles": geometry.triangles.buffer,
                "Rays": rays,
                "Hits": hits,
                "CameraPaths": paths,
            },
        )

    def release(self) -> None:
        for resource in (self._framebuffer, self._visibility, self._depth, self.camera):
            resource.release()
