# SPDX-License-Identifier: GPL-3.0-or-later
"""Whose light photons carry: the light groups of the lights that they left."""

import moderngl

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..common.stage_sizes import StageSizes, grouped_photons
from ..device_scene.stage_context import StageContext

Record("PhotonGroupParameters", count="uint")


class PhotonGroups(BufferSet):
    """A number for each photon that leaves a light; without light groups neither a program nor a buffer."""

    remedy = "lower the photons per iteration"
    groups = StorageBuffer("light groups of photons", "uint", grouped_photons, block="PhotonGroups")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._find = library.compute("photons/photon_groups/find.comp") if sizes.light_groups else None

    def find(self, context: StageContext, rays: moderngl.Buffer, photons: int) -> None:
        """Take the groups of so many photons, whose rays (RAY) have just left the lights."""
        if self._find is None:
            return
        self._find.run(
            photons,
            {**context.blocks, **self.blocks, "Rays": rays},
            {"count": photons},
        )
