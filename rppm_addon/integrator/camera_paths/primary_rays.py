# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits of panoramas, of cameras with an aperture, and of others where tracing is faster."""

import numpy as np

from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.camera import Camera, PanoramaKind, SphericalStereo
from ...scene.errors import SceneError
from ..common.band import Band
from ..common.stage_sizes import StageSizes
from ..density_estimation.stored_photons import CameraRaster
from ..device_scene.stage_context import StageContext
from .camera_hits import CameraHits
from .importons import Importons

Record(
    "PrimaryRaysParameters", first_pixel="uint", stereo_offset="float", convergence_distance="float", pole_merge="vec2"
)
"""``stereo_offset``: meters to the right of where the camera looks; ``convergence_distance``: meters, 0 is parallel;
``pole_merge``: altitudes, radians, between which the offset fades, of which the second is 0 where it does not."""


def stereo_parameters(camera: Camera) -> dict[str, float | tuple[float, float]]:
    """Return the members of PrimaryRaysParameters that a camera's spherical stereo sets.

    Raises SceneError where they are not finite.
    """
    stereo = camera.stereo or SphericalStereo(0.0)
    # Cycles' axes of mirror balls are mirrored, which exchanges the eyes.
    is_mirrored = camera.panorama is not None and camera.panorama.kind is PanoramaKind.MIRRORBALL
    parameters: dict[str, float | tuple[float, float]] = {
        "stereo_offset": -stereo.offset if is_mirrored else stereo.offset,
        "convergence_distance": stereo.convergence_distance or 0.0,
        "pole_merge": stereo.pole_merge or (0.0, 0.0),
    }
    if not all(np.isfinite(value).all() for value in parameters.values()):
        raise SceneError("the camera's spherical stereo is not finite; reset its Stereoscopy")
    return parameters


class PrimaryRays(CameraHits):
    """Stands in for the GBuffer where rays do not come from one point, or meet no plane, and where tracing them is
    faster than rasterizing all triangles."""

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._rays = library.compute("camera_paths/primary_rays/rays.comp")
        self._is_on_raster = sizes.first_camera_hits is not None

    def raster(self, band: Band) -> CameraRaster | None:
        """CameraHits.raster."""
        return CameraRaster(self.camera.buffer, band.columns, band.rows) if self._is_on_raster else None

    def find(self, context: StageContext, importons: Importons, view: np.ndarray, band: Band) -> None:
        """First rays, hits and camera paths of the band that ``view`` (CAMERA_VIEW) shows."""
        with context.timers.stage("gbuffer"):
            importons.active.fill(band.pixel_count)
            self.camera.write(view)
            self._rays.run(
                band.pixel_count,
                {**context.blocks, **importons.blocks, **self.blocks},
                {"first_pixel": band.first_pixel, **stereo_parameters(context.scene.camera)},
            )
            importons.find_hits(context)
