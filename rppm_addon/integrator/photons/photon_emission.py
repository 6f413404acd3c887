# SPDX-License-Identifier: GPL-3.0-or-later
"""The first part of DirectPhotonHits: photons leave the lights."""

from collections.abc import Mapping

from ...gl.buffers.records import Record
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ..common.active_paths import ActivePaths
from ..device_scene.stage_context import StageContext
from ..lights.emitters.programs import EmitterProgram

Record("EmitParameters", world_transmittance="vec3", count="uint", target_count="uint", fills_world="uint")
Record("FalloffParameters", count="uint")


class PhotonEmission:
    """Programs that place and direct photons, and end those that a soft light does not send to where they hit."""

    def __init__(self, library: ProgramLibrary) -> None:
        self._emit = EmitterProgram(library, "photons/photon_emission/emit.comp")
        self._falloff = library.compute("photons/photon_emission/falloff.comp")
        self._library = library

    def emit(self, context: StageContext, photons: Mapping[str, Bindable], count: int) -> None:
        """Emit ``count`` photons: their first rays, the flux they carry, what the world is like there, and how their
        neighbors leave.

        photons: storage blocks of the photons (Photons.blocks), as for the other programs.
        """
        self._emit.of(context.lights.emitters.instances).run(
            count,
            {**context.blocks, **photons},
            {
                "count": count,
                "target_count": context.lights.target_count,
                "world_transmittance": context.materials.media.world_transmittance,
                "fills_world": context.materials.media.fills_world,
            },
        )

    def apply_falloff(self, context: StageContext, photons: Mapping[str, Bindable], count: int) -> None:
        """End photons at first hits that a soft light does not reach, and weight the others by their distance."""
        self._falloff.run(count, {**context.blocks, **photons}, {"count": count})

    def cut_soft_lights(self, context: StageContext, photons: Mapping[str, Bindable], active: ActivePaths) -> None:
        """End photons at first hits from which their point on a soft light is occluded."""
        program = self._library.compute("photons/photon_emission/cut.comp", context.acceleration.traversal_defines)
        active.run(program, {**context.blocks, **photons})
