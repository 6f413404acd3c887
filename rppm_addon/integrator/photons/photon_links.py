# SPDX-License-Identifier: GPL-3.0-or-later
"""Light and shadow linking of photons that come straight from their lights."""

import moderngl

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..common.active_paths import ActivePaths
from ..common.stage_sizes import StageSizes, linked_photons
from ..device_scene.stage_context import StageContext

StorageBlock("PhotonLinks", "uint photon_links[];")
"""LightLinks numbers of the photons that left the lights."""


Record("PhotonLinkParameters", count="uint")


class PhotonLinks(BufferSet):
    """Light links of each photon, by number: what its light shines on and what stops that light. Where no light is
    linked, there are neither programs nor a buffer."""

    remedy = "lower the photons per iteration"
    _links = StorageBuffer("light links of photons", "uint", linked_photons, block="PhotonLinks")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._find = library.compute("photons/photon_links/find.comp") if sizes.links_lights else None
        self._link = library.compute("photons/photon_links/link.comp") if sizes.links_lights else None

    def find(self, context: StageContext, rays: moderngl.Buffer, photons: int) -> None:
        """Take the links of so many photons, whose rays (RAY) have just left the lights."""
        if self._find is None:
            return
        self._find.run(
            photons,
            {**context.blocks, **self.blocks, "Rays": rays},
            {"count": photons},
        )

    def link(
        self, context: StageContext, closures: moderngl.Buffer, paths: moderngl.Buffer, active: ActivePaths
    ) -> None:
        """Change the closures (CLOSURE) that active photon paths (PHOTON_PATH) have come to."""
        if self._link is None:
            return
        active.run(
            self._link,
            {**context.blocks, **self.blocks, "Closures": closures, "PhotonPaths": paths},
        )
