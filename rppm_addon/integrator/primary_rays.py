# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits of panoramas and of cameras with an aperture: rays through the deep cubemap."""

import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from .importons import Importons
from .records import CAMERA_VIEW
from .stages import Stages

Record("PrimaryRaysParameters", first_pixel="uint", seed="uint", iteration="uint")


class PrimaryRays:
    """Stands in for the GBuffer where rays do not come from one point, or meet no plane."""

    rasterizes = False
    memory_bytes = 0

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        self._rays = library.compute("gbuffer/rays.comp")
        self._camera = GrowingBuffer(context, "camera")
        self._camera.require(CAMERA_VIEW.size)
        self.camera = self._camera.buffer

    def run(self, stages: Stages, importons: Importons, view: np.ndarray, first_pixel: int, iteration: int) -> None:
        """First rays, hits and camera paths of the band that ``view`` (CAMERA_VIEW) describes."""
        self._camera.upload(view)
        count = int(view["width"][0] * view["height"][0])
        self._rays.run(
            count,
            {"Camera": self.camera, "Rays": importons.rays.buffer, "CameraPaths": importons.paths.buffer},
            # The iterations' points start with the first of the set.
            {"first_pixel": first_pixel, "seed": stages.settings.seed, "iteration": max(iteration - 1, 0)},
        )
        importons.trace(stages)

    def release(self) -> None:
        self._camera.release()
