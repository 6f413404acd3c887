# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of which the camera sees the shadows only."""

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..camera_paths.importons import Importons
from ..common.band import Band
from ..common.records.rays import RAY
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes, band_pixels
from ..device_scene.stage_context import StageContext
from ..lights.emitters.programs import EmitterProgram

StorageBlock("CatcherVisibility", "uint catcher_visibility[];")
Record("ShadowCatcherParameters", segment="uint", first_pixel="uint")


class ShadowCatcher(Stage):
    """One shadow ray from each catcher that a camera path meets, to a light chosen by what it would give without
    shadows: ``lit`` is then 1 with the probability that
    the light arrives. Light that other surfaces send is left out."""

    memory_group = "shadow catcher"
    remedy = "lower the resolution"
    _rays = StorageBuffer("rays from shadow catchers", RAY, band_pixels, block="ShadowRays")
    _links = StorageBuffer("links of shadow catchers", "vec4", band_pixels, block="Contributions")
    """Contributions without light."""
    _triangles = StorageBuffer("triangles of lights of shadow catchers", "uint", band_pixels, block="LightTriangles")
    lit = StorageBuffer("lit shadow catchers", "uint", band_pixels, block="CatcherVisibility")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._program = EmitterProgram(library, "direct_light/shadow_catcher/cast.comp") if self.is_on else None

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where objects catch shadows."""
        return sizes.has_catchers

    def cast(self, context: StageContext, importons: Importons, band: Band, segment: int) -> None:
        """Fill ``lit`` for the resolved vertices of the active camera paths, before they scatter on."""
        if self._program is None:
            return
        with context.timers.stage("shadow catcher"):
            importons.active.run(
                self._program.of(context.lights.emitters.instances),
                {**context.blocks, **importons.blocks, **self.blocks},
                {"segment": segment, "first_pixel": band.first_pixel},
            )
            linking = context.lights.linking_blocks(self._links.buffer)
            context.acceleration.occluded(
                self._rays.buffer, self._triangles.buffer, self.lit.buffer, importons.active, linking
            )
