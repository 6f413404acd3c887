# SPDX-License-Identifier: GPL-3.0-or-later
"""Light and shadow linking of photons that come straight from their lights."""

import moderngl

from ...gl.buffer_sets import BufferSet, ComputeShader, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..common.active_paths import ActivePaths
from ..common.stage_sizes import StageSizes, photon_paths
from ..device_scene.stage_context import StageContext
from ..lights.emitters.programs import EmitterProgram

StorageBlock("PhotonLinks", "uint photon_links[];")
"""LightLinks numbers of the photons that left the lights."""


Record("PhotonLinkParameters", count="uint")


class PhotonLinks(BufferSet):
    """Light links of each photon, by number: what its light shines on and what stops that light."""

    remedy = "lower the photons per iteration"
    _links = StorageBuffer("light links of photons", "uint", photon_paths, block="PhotonLinks")
    _link = ComputeShader("photons/photon_links/link.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._find = EmitterProgram(library, "photons/photon_links/find.comp") if self.is_on else None

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """BufferSet.is_needed: where lights are linked."""
        return sizes.links_lights

    def find(self, context: StageContext, rays: moderngl.Buffer, photons: int) -> None:
        """Take the links of so many photons, whose rays (RAY) have just left the lights."""
        if self._find is None:
            return
        self._find.of(context.lights.emitters.instances).run(
            photons,
            {**context.blocks, **self.blocks, "Rays": rays},
            {"count": photons},
        )

    def link(
        self, context: StageContext, closures: moderngl.Buffer, paths: moderngl.Buffer, active: ActivePaths
    ) -> None:
        """Change the closures (CLOSURE) that active photon paths (PHOTON_PATH) have come to."""
        if not self.is_on:
            return
        active.run(
            self._link,
            {**context.blocks, **self.blocks, "Closures": closures, "PhotonPaths": paths},
        )
