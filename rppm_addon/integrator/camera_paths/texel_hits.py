# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectCameraHits of textures that are baked: camera paths begin at given points of a mesh."""

import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.camera import Camera, Texels
from ...scene.errors import SceneError
from ..common.band import Band
from ..common.records.rays import NO_TRIANGLE
from ..common.stage_sizes import StageSizes, band_pixels
from ..density_estimation.stored_photons import CameraRaster
from ..device_scene.stage_context import StageContext
from ..surfaces.placements import Placement
from .camera_hits import CameraHits
from .importons import Importons

TEXEL = Record("Texel", triangle="uint", b1="float", b2="float", unused="float", differentials="vec4")
"""A place on a world triangle (HIT) and what its barycentric coordinates change by (scene.Texels)."""
Record(
    "TexelParameters",
    viewer="vec4",
    count="uint",
    first_pixel="uint",
    straight_down="uint",
    see_environment="uint",
)


class TexelHits(CameraHits):
    """Stands in for the GBuffer where the first hits of camera paths are given (scene.Texels)."""

    _texels = StorageBuffer("baked texels", TEXEL, band_pixels, block="BakedTexels")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._program = library.compute("camera_paths/texel_hits/hits.comp")

    def raster(self, band: Band) -> CameraRaster | None:
        """None: first hits lie on no raster."""
        return None

    def find(self, context: StageContext, importons: Importons, view: np.ndarray, band: Band) -> None:
        """First rays, hits and camera paths of the texels that ``view`` (CAMERA_VIEW) shows.

        Raises SceneError when their object has no triangles.
        """
        camera = context.scene.camera
        texels = camera.texels
        assert texels is not None
        placement = _placement_of(context, texels)
        with context.timers.stage("gbuffer"):
            importons.active.fill(band.pixel_count)
            self.camera.write(view)
            self._texels.write(texel_records(camera, texels, placement, view))
            self._program.run(
                band.pixel_count,
                {**context.blocks, **importons.blocks, **self.blocks},
                {
                    "viewer": texels.viewer or (0.0, 0.0, 0.0, 0.0),
                    "count": band.pixel_count,
                    "first_pixel": band.first_pixel,
                    "straight_down": texels.viewer is None,
                    "see_environment": texels.see_environment,
                },
            )


def _placement_of(context: StageContext, texels: Texels) -> Placement:
    chosen = context.geometry.placed_meshes.chosen
    number = int(np.searchsorted(chosen, texels.instance))
    if number < len(chosen) and chosen[number] == texels.instance:
        return context.geometry.placements[number]
    name = context.scene.instances[texels.instance].object_name
    raise SceneError(f'object "{name}" has no faces that can be baked; give its mesh some')


def texel_records(camera: Camera, texels: Texels, placement: Placement, view: np.ndarray) -> np.ndarray:
    """(pixels,) TEXEL records of those texels that lie in the middles of a view's pixels (CAMERA_VIEW)."""
    x_min, y_min, _, _ = camera.region
    left, right, bottom, top = view["window"][0].astype(np.float64)
    columns, rows = int(view["width"][0]), int(view["height"][0])
    height, width = texels.triangles.shape
    column = left + (right - left) * (np.arange(columns) + 0.5) / columns - x_min
    row = bottom + (top - bottom) * (np.arange(rows) + 0.5) / rows - y_min
    chosen = np.ix_(np.clip(row.astype(int), 0, height - 1), np.clip(column.astype(int), 0, width - 1))
    records = TEXEL.zeros(rows * columns)
    triangles = texels.triangles[chosen].reshape(-1)
    records["triangle"] = np.where(triangles >= 0, placement.first_triangle + triangles, np.uint32(NO_TRIANGLE))
    second, third = texels.barycentrics[chosen].reshape(-1, 2).T
    differentials = texels.differentials[chosen].reshape(-1, 4)
    if np.linalg.det(placement.instance.matrix[:3, :3]) < 0.0:  # world triangles are then wound the other way round
        second, third, differentials = third, second, differentials[:, [2, 3, 0, 1]]
    records["b1"], records["b2"], records["differentials"] = second, third, differentials
    return records
