# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits: the camera's first hits by rasterization, in bands of rows."""

import moderngl
import numpy as np

from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from .importons import Importons
from .low_discrepancy import scrambled_sobol
from .records import CAMERA_VIEW
from .stages import Stages


def filter_offsets(iteration: int, width: float, seed: int) -> tuple[float, float]:
    """Subpixel offset of an iteration (from 1), in pixels, by the density of a Blackman-Harris
    filter, at Owen-scrambled Sobol points.

    The filter reaches over twice its width, as Cycles' does (measured).
    """
    x = np.linspace(-0.5, 0.5, 1025)
    density = (
        0.35875 + 0.48829 * np.cos(2 * np.pi * x) + 0.14128 * np.cos(4 * np.pi * x) + 0.01168 * np.cos(6 * np.pi * x)
    )
    cumulated = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    scramble = np.random.default_rng((seed, 2)).integers(1 << 32, size=3)
    u = scrambled_sobol(iteration - 1, tuple(map(int, scramble)))
    return tuple(float(2.0 * width * np.interp(value, cumulated / cumulated[-1], x)) for value in u)


class GBuffer:
    """A visibility buffer of one band: the nearest triangle of each pixel."""

    rasterizes = True

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

    def run(self, stages: Stages, importons: Importons, view: np.ndarray, first_pixel: int, iteration: int) -> None:
        """First rays, hits and camera paths of the band that ``view`` (CAMERA_VIEW) describes."""
        geometry = stages.geometry
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
                "Rays": importons.rays.buffer,
                "Hits": importons.hits.buffer,
                "CameraPaths": importons.paths.buffer,
            },
        )

    def release(self) -> None:
        for resource in (self._framebuffer, self._visibility, self._depth, self.camera):
            resource.release()
