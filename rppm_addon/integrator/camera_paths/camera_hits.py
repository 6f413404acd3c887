# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits: base class of the stages that compute the camera's first hits."""

import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ..common.band import Band
from ..common.camera_view import CAMERA_VIEW
from ..common.stage import Stage
from ..density_estimation.stored_photons import CameraRaster
from ..device_scene.stage_context import StageContext
from .importons import Importons


class CameraHits(Stage):
    """Base of the stages that compute the camera's first hits, such as GBuffer and PrimaryRays."""

    memory_group = "camera paths"
    camera = StorageBuffer("camera", CAMERA_VIEW, 1, block="Camera")

    def raster(self, band: Band) -> CameraRaster | None:
        """Raster of the band's first hits, onto which photons are splatted; None where they lie on none."""
        raise NotImplementedError

    def find(self, context: StageContext, importons: Importons, view: np.ndarray, band: Band) -> None:
        """Compute the first rays and hits of a band in a view (CAMERA_VIEW), and begin its camera paths."""
        raise NotImplementedError
