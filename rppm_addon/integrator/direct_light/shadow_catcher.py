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

StorageBlock("CatcherVisibility", "uint catcher_visibility[];")


Record("ShadowCatcherParameters", segment="uint", first_pixel="uint")


def _catching_pixels(sizes: StageSizes) -> int:
    return band_pixels(sizes) if sizes.has_catchers else 0


class ShadowCatcher(Stage):
    """One shadow ray from each catcher that a camera path meets, to a light chosen by what it would give without
    shadows: ``lit`` is then 1 as often as the share of the light that arrives. Light that other surfaces send is left
    out. Without catchers nothing is run."""

    memory_group = "shadow catcher"
    remedy = "lower the resolution"
    _rays = StorageBuffer("rays from shadow catchers", RAY, _catching_pixels, block="ShadowRays")
    _links = StorageBuffer("links of shadow catchers", "vec4", _catching_pixels, block="Contributions")
    """Contributions without light."""
    _triangles = StorageBuffer(
        "triangles of lights of shadow catchers", "uint", _catching_pixels, block="LightTriangles"
    )
    lit = StorageBuffer("lit shadow catchers", "uint", _catching_pixels, block="CatcherVisibility")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._program = library.compute("direct_light/shadow_catcher/cast.comp") if sizes.has_catchers else None

    def cast(self, context: StageContext, importons: Importons, band: Band, segment: int) -> None:
        """Fill ``lit`` for the resolved vertices of the active camera paths, before they scatter on."""
        if self._program is None:
            return
        with context.timers.stage("shadow catcher"):
            importons.active.run(
                self._program,
                {**context.blocks, **importons.blocks, **self.blocks},
                {"segment": segment, "first_pixel": band.first_pixel},
            )
            linking = context.lights.linking_blocks(self._links.buffer)
            context.acceleration.occluded(
                self._rays.buffer, self._triangles.buffer, self.lit.buffer, importons.active, linking
            )
