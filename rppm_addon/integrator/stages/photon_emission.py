# SPDX-License-Identifier: GPL-3.0-or-later
"""The first part of DirectPhotonHits: photons leave the lights."""

from collections.abc import Mapping

import moderngl

from ...gl.programs import ProgramLibrary
from ...gl.records import Record
from ..common.iteration import Iteration
from ..common.living_paths import LivingPaths
from ..device_scene.stage_context import StageContext
from ..lights.lights import LIGHT_PARAMETERS, Lights

Record("EmitParameters", **LIGHT_PARAMETERS, count="uint", target_count="uint")
Record("FalloffParameters", **LIGHT_PARAMETERS, count="uint")
Record("CutParameters", light_count="uint")
Record("PortalPassedParameters", **LIGHT_PARAMETERS)


class PhotonEmission:
    """Programs that place and direct photons, and end those that a soft light does not send to where they hit."""

    def __init__(self, library: ProgramLibrary) -> None:
        self._emit = library.compute("photon_emission/emit.comp")
        self._falloff = library.compute("photon_emission/falloff.comp")
        self._library = library

    def emit(
        self,
        lights: Lights,
        rays: moderngl.Buffer,
        photon_paths: moderngl.Buffer,
        photon_origins: moderngl.Buffer,
        differentials: moderngl.Buffer,
        count: int,
        iteration: Iteration,
    ) -> None:
        """Emit ``count`` photons: their first rays, the flux they carry, what the world is like there, and how their
        neighbors leave."""
        self._emit.run(
            count,
            {
                **lights.buffers,
                **lights.guide.buffers,
                "Rays": rays,
                "PhotonPaths": photon_paths,
                "PhotonOrigins": photon_origins,
                "PhotonDifferentials": differentials,
                "Targets": lights.targets.buffer,
            },
            {**lights.parameters(iteration), "count": count, "target_count": lights.target_count},
        )

    def apply_falloff(
        self,
        lights: Lights,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        photon_paths: moderngl.Buffer,
        count: int,
        iteration: Iteration,
    ) -> None:
        """Where photons hit first: end those that a soft light does not send there, and let the distance count."""
        self._falloff.run(
            count,
            {**lights.buffers, "Rays": rays, "Hits": hits, "PhotonPaths": photon_paths},
            {**lights.parameters(iteration), "count": count},
        )

    def cut_soft_lights(
        self,
        context: StageContext,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        photon_paths: moderngl.Buffer,
        living: LivingPaths,
    ) -> None:
        """Where photons hit first: end those of soft lights whose place on the light something hides from there."""
        acceleration, lights = context.acceleration, context.lights
        program = self._library.compute("photon_emission/cut.comp", acceleration.traversal_defines)
        living.run(
            program,
            {
                **acceleration.traversal_buffers,
                "Lights": lights.table_buffer,
                "Rays": rays,
                "Hits": hits,
                "PhotonPaths": photon_paths,
            },
            {"light_count": len(lights.table)},
        )

    def leave_to_shadow_rays(
        self, lights: Lights, blocks: Mapping[str, moderngl.Buffer], living: LivingPaths, iteration: Iteration
    ) -> None:
        """Where direct photons hit: mark those that came through a portal, whose light shadow rays bring. blocks: Rays,
        Hits, PhotonPaths and PhotonOrigins."""
        program = self._library.compute("photon_emission/portal_passed.comp", {"PORTALS": 1})
        living.run(program, {**lights.buffers, **blocks}, lights.parameters(iteration))
