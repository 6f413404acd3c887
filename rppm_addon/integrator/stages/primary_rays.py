# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits of panoramas and of cameras with an aperture: rays through the deep cubemap."""

import numpy as np

from ...gl.buffers import GrowingBuffer
from ...gl.context import Context
from ...gl.programs import ProgramLibrary
from ...gl.records import Record
from ..common.band import Band
from ..common.iteration import Iteration
from ..common.records import CAMERA_VIEW
from ..density_estimation.stored_photons import CameraRaster
from ..device_scene.stage_context import StageContext
from .importons import Importons

Record("PrimaryRaysParameters", first_pixel="uint", seed="uint", iteration="uint")


class PrimaryRays:
    """Stands in for the GBuffer where rays do not come from one point, or meet no plane."""

    memory_bytes = 0

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        self._rays = library.compute("primary_rays/rays.comp")
        self._camera = GrowingBuffer(context, "camera")
        self._camera.require(CAMERA_VIEW.size)
        self.camera = self._camera.buffer

    def raster(self, band: Band) -> CameraRaster | None:
        """None: first hits lie on no raster."""
        return None

    def find(
        self, context: StageContext, importons: Importons, view: np.ndarray, band: Band, iteration: Iteration
    ) -> None:
        """First rays, hits and camera paths of the band that ``view`` (CAMERA_VIEW) shows."""
        with context.timers.stage("gbuffer"):
            importons.living.fill(band.pixel_count)
            self._camera.upload(view)
            self._rays.run(
                band.pixel_count,
                {"Camera": self.camera, "Rays": importons.rays.buffer, "CameraPaths": importons.paths.buffer},
                # The iterations' points start with the first of the set.
                {
                    "first_pixel": band.first_pixel,
                    "seed": iteration.seed,
                    "iteration": max(iteration.number - 1, 0),
                },
            )
            importons.find_hits(context)

    def release(self) -> None:
        """Give the buffers back."""
        self._camera.release()
