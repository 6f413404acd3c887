# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass Ambient Occlusion: how far first surfaces are open to what is around them."""

from ...gl.buffer_sets import ComputeShader
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.passes import AMBIENT_OCCLUSION
from ..common.stage_sizes import StageSizes
from .events import BandEvents, Listener
from .film import pass_bits

Record("AmbientOcclusionParameters", pixels="uint", passes="uint", segment="uint", first_pixel="uint", reach="float")


class AmbientOcclusion(Listener):
    """One ray around the normal of each surface that the camera sees, as in Cycles: the pass is the fraction of the
    rays that come as far as the world's distance, and past transparent surfaces what these let through.

    It traces by the buffers of direct light, and so comes after all listeners that read these.
    """

    memory_group = "passes"
    _cast = ComputeShader("film/ambient_occlusion/cast.comp")
    _add = ComputeShader("film/ambient_occlusion/add.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._passes = pass_bits(sizes)

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where the pass is rendered."""
        return AMBIENT_OCCLUSION in sizes.passes

    def direct_light_added(self, events: BandEvents, segment: int) -> None:
        """Listener.direct_light_added: add what the rays of a segment's surfaces find."""
        if not events.iteration.enters_film:
            return
        context, importons, shadow_rays = events.context, events.importons, events.direct_light
        parameters = {
            "pixels": events.band.pixel_count,
            "passes": self._passes,
            "segment": segment,
            "first_pixel": events.band.first_pixel,
            "reach": context.scene.world.ambient_occlusion_distance,
        }
        with context.timers.stage("ambient occlusion"):
            blocks = {**context.blocks, **importons.blocks, **shadow_rays.blocks}
            importons.active.run(self._cast, blocks, parameters)
            shadow_rays.trace_rays(context, importons, events.iteration, segment)
            shadow_rays.active_rays.run(self._add, blocks, parameters)
