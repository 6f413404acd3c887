# SPDX-License-Identifier: GPL-3.0-or-later
"""TraceImportons: camera paths through specular surfaces, and the importons they leave."""

import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ..common.active_paths import PathList
from ..common.band import Band
from ..common.iteration import Iteration
from ..common.records import bounce_counts  # noqa: F401  declares constants
from ..common.records.camera_paths import CAMERA_PATH
from ..common.records.closures import CLOSURE
from ..common.records.importons import IMPORTON
from ..common.records.rays import HIT, RAY
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes, aov_channels, band_pixels, exiting_pixels
from ..density_estimation.stored_photons import CameraRaster, SplatTargets
from ..device_scene.stage_context import StageContext
from ..lights.emitters.programs import EmitterProgram
from ..surfaces.resolve import CameraPaths

Record("ScatterImportonsParameters", segment="uint", first_pixel="uint")


def _band_aovs(sizes: StageSizes) -> int:
    return band_pixels(sizes) * aov_channels(sizes)


class Importons(Stage):
    """Camera paths of one band, with the importon that each leaves in the current segment."""

    memory_group = "camera paths"
    remedy = "lower the resolution"
    rays = StorageBuffer("camera rays", RAY, band_pixels, block="Rays")
    hits = StorageBuffer("camera hits", HIT, band_pixels, block="Hits")
    paths = StorageBuffer("camera paths", CAMERA_PATH, band_pixels, block="CameraPaths")
    closures = StorageBuffer("camera closures", CLOSURE, band_pixels, block="Closures")
    exit_closures = StorageBuffer("exit closures", CLOSURE, exiting_pixels, block="ExitClosures")
    """Closures at the exits of subsurface walks, and those of ``closures`` for other paths; empty where no material has
    subsurface scattering."""
    importons = StorageBuffer("importons", IMPORTON, band_pixels, block="Importons")
    radiances = StorageBuffer("band radiance", "vec4", band_pixels, block="Radiances")
    aovs = StorageBuffer("band AOVs", "float", _band_aovs, block="AovValues")
    """Channels of the AOV passes for each path, as the nodes of materials add to them."""
    active = PathList("active camera paths", band_pixels, to_keep=True)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._scatter = EmitterProgram(library, "camera_paths/importons/scatter.comp")
        self._lit_closures = self.exit_closures if sizes.has_subsurface else self.closures
        self._opaque = np.tile(np.array([0, 0, 0, 1], np.float32), (band_pixels(sizes), 1)).tobytes()

    def clear(self) -> None:
        """Clear the radiance and the AOVs of the previous band."""
        self.radiances.buffer.write(self._opaque)
        if self.aovs.size:
            self.aovs.clear()

    @property
    def lit_blocks(self) -> dict[str, Bindable]:
        """The blocks for programs that light the paths: Closures are those at the exits of subsurface walks."""
        return self.blocks | {"Closures": self._lit_closures.buffer}

    def trace(self, context: StageContext, segment: int) -> bool:
        """Trace the rays of the active paths. Returns False where no path is active."""
        with context.timers.stage("camera tracing"):
            self.active.keep(self.rays.buffer)
            if not self.active.bound(segment):
                return False
            self.find_hits(context)
            return True

    def find_hits(self, context: StageContext) -> None:
        """Intersect the rays of the active paths with the scene."""
        context.acceleration.trace(self.rays.buffer, self.hits.buffer, self.active)

    def resolve(self, context: StageContext, iteration: Iteration, segment: int) -> None:
        """Turn the hits of a segment into closures."""
        with context.timers.stage("camera resolve"):
            context.resolve.run(
                self.rays.buffer,
                self.hits.buffer,
                self.closures.buffer,
                self.active,
                iteration.number,
                segment,
                camera_paths=CameraPaths(self.paths.buffer, self.aovs.buffer),
            )

    def scatter(self, context: StageContext, band: Band, segment: int) -> None:
        """Add emission, leave importons, and sample the rays of the next segment."""
        with context.timers.stage("camera scattering"):
            self.active.run(
                self._scatter.of(context.lights.emitters.instances),
                {**context.blocks, **self.lit_blocks},
                {"segment": segment, "first_pixel": band.first_pixel},
            )

    def splat_targets(self, context: StageContext, segment: int, raster: CameraRaster | None) -> SplatTargets:
        """Return the segment's importons, to take photons; ``raster``: where its hits lie on the camera's raster."""
        return SplatTargets(
            self.importons.buffer,
            self.paths.buffer,
            self.active,
            gathers=segment == 0 and context.gathers,
            final_gather=segment > 0 and context.gathers,
            raster=raster,
            center=context.center,
        )

    def footprints(self, count: int) -> np.ndarray:
        """(count,) radii of the importons just left, meters; 0 where there is none."""
        return self.importons.read(IMPORTON.dtype, count)["radius"]
