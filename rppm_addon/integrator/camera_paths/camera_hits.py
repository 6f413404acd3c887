# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits, by whichever way the camera's first hits are found."""

import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ..common.band import Band
from ..common.camera_view import CAMERA_VIEW
from ..common.stage import Stage
from ..density_estimation.stored_photons import CameraRaster
from ..device_scene.stage_context import StageContext
from .importons import Importons


class CameraHits(Stage):
    """Common base of the stages that find the camera's first hits, such as GBuffer and PrimaryRays."""

    memory_group = "camera paths"
    camera = StorageBuffer("camera", CAMERA_VIEW, 1, block="Camera")

    def raster(self, band: Band) -> CameraRaster | None:
        """Where the band's first hits lie, for photons to be splatted onto; None where they lie on no raster."""
        raise NotImplementedError

    def find(self, context: StageContext, importons: Importons, view: np.ndarray, band: Band) -> None:
        """First rays, hits and camera paths of the band that ``view`` (CAMERA_VIEW) shows."""
        raise NotImplementedError
