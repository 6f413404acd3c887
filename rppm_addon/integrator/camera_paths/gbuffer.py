# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits: the camera's first hits by rasterization, in bands of rows."""

import moderngl
import numpy as np

from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.camera import Camera
from ...scene.settings import PixelFilter, RenderSettings
from ..common.band import Band
from ..common.camera_view import camera_view
from ..common.iteration import Iteration
from ..common.low_discrepancy import scrambled_sobol
from ..common.stage_sizes import StageSizes
from ..density_estimation.stored_photons import CameraRaster
from ..device_scene.stage_context import StageContext
from .camera_hits import CameraHits
from .importons import Importons


def _filter_density(kind: PixelFilter, x: np.ndarray) -> np.ndarray:
    """Return the density at x of a pixel filter that reaches from -0.5 to 0.5."""
    if kind is PixelFilter.BLACKMAN_HARRIS:
        return (
            0.35875
            + 0.48829 * np.cos(2 * np.pi * x)
            + 0.14128 * np.cos(4 * np.pi * x)
            + 0.01168 * np.cos(6 * np.pi * x)
        )
    return np.exp(-72.0 * x * x) if kind is PixelFilter.GAUSSIAN else np.ones_like(x)


def filter_offsets(
    iteration: int, width: float, seed: int, kind: PixelFilter = PixelFilter.BLACKMAN_HARRIS
) -> tuple[float, float]:
    """Subpixel offset of an iteration (from 1), in pixels, by the density of a pixel filter, at Owen-scrambled Sobol
    points.

    As Cycles' do, a Blackman-Harris filter reaches over twice its width, a Gaussian over three times, and a box is one
    pixel wide.
    """
    x = np.linspace(-0.5, 0.5, 1025)
    density = _filter_density(kind, x)
    reach = {PixelFilter.BOX: float(width > 0.0), PixelFilter.GAUSSIAN: 3.0 * width}.get(kind, 2.0 * width)
    cumulated = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    first, second, third = map(int, np.random.default_rng((seed, 2)).integers(1 << 32, size=3))
    u = scrambled_sobol(iteration - 1, (first, second, third))
    across, up = (float(reach * np.interp(value, cumulated / cumulated[-1], x)) for value in u)
    return across, up


def jittered_view(camera: Camera, settings: RenderSettings, band: Band, iteration: Iteration) -> np.ndarray:
    """CAMERA_VIEW record of a band of the camera's region, with the iteration's subpixel offset.

    Texels have offsets of their own.
    """
    offset = 0.0, 0.0
    if camera.texels is None:
        offset = filter_offsets(iteration.number, settings.filter_width, iteration.seed, settings.pixel_filter_type)
    return camera_view(camera, band.first_row, band.rows, offset)


class GBuffer(CameraHits):
    """A visibility buffer of one band: the nearest triangle of each pixel."""

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        gl, size = context.moderngl, (sizes.width, sizes.bands[0].rows)
        self._draw = library.draw("camera_paths/gbuffer/visibility.vert", "camera_paths/gbuffer/visibility.frag")
        self._hits = library.compute("camera_paths/gbuffer/hits.comp")
        self._visibility = self.own(gl.texture(size, 2, dtype="f4"), "visibility buffer")
        self._visibility.filter = (moderngl.NEAREST, moderngl.NEAREST)
        depth = self.own(gl.depth_texture(size), "visibility buffer")
        self._framebuffer = self.own(gl.framebuffer([self._visibility], depth))

    def raster(self, band: Band) -> CameraRaster | None:
        """Raster of the band's first hits, onto which photons are splatted."""
        return CameraRaster(self.camera.buffer, band.columns, band.rows)

    def find(self, context: StageContext, importons: Importons, view: np.ndarray, band: Band) -> None:
        """First rays, hits and camera paths of the band that ``view`` (CAMERA_VIEW) shows."""
        geometry = context.geometry
        with context.timers.stage("gbuffer"):
            importons.active.fill(band.pixel_count)
            self.camera.write(view)
            self._framebuffer.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
            self._draw.draw(
                self._framebuffer,
                3 * geometry.triangle_count,
                {**context.blocks, **self.blocks},
                viewport=(0, 0, band.columns, band.rows),
                state=moderngl.DEPTH_TEST,
            )
            self._hits.run(
                band.pixel_count,
                {**context.blocks, **importons.blocks, **self.blocks, "visibility": self._visibility},
            )
