# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits of panoramas and of cameras with an aperture: rays through the deep cubemap."""

import numpy as np

from ...gl.context import Context
from ...gl.programs import ProgramLibrary
from ...gl.records import Record
from ..common.band import Band
from ..common.iteration import Iteration
from ..common.stage_sizes import StageSizes
from ..density_estimation.stored_photons import CameraRaster
from ..device_scene.stage_context import StageContext
from .camera_hits import CameraHits
from .importons import Importons

Record("PrimaryRaysParameters", first_pixel="uint", seed="uint", iteration="uint")


class PrimaryRays(CameraHits):
    """Stands in for the GBuffer where rays do not come from one point, or meet no plane."""

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._rays = library.compute("primary_rays/rays.comp")

    def raster(self, band: Band) -> CameraRaster | None:
        """None: first hits lie on no raster."""
        return None

    def find(
        self, context: StageContext, importons: Importons, view: np.ndarray, band: Band, iteration: Iteration
    ) -> None:
        """First rays, hits and camera paths of the band that ``view`` (CAMERA_VIEW) shows."""
        with context.timers.stage("gbuffer"):
            importons.living.fill(band.pixel_count)
            self.camera.write(view)
            self._rays.run(
                band.pixel_count,
                {"Camera": self.camera.buffer, "Rays": importons.rays.buffer, "CameraPaths": importons.paths.buffer},
                # The iterations' points start with the first of the set.
                {
                    "first_pixel": band.first_pixel,
                    "seed": iteration.seed,
                    "iteration": max(iteration.number - 1, 0),
                },
            )
            importons.find_hits(context)
