# SPDX-License-Identifier: GPL-3.0-or-later
"""Light groups of photons: those of the lights that they left."""

import moderngl

from ...gl.buffer_sets import BufferSet, ComputeShader
from ...gl.buffers.records import Record
from ..common.stage_sizes import StageSizes
from ..device_scene.stage_context import StageContext

Record("PhotonGroupParameters", count="uint")


class PhotonGroups(BufferSet):
    """Enters the light group of each photon, that of the light which it left, into PhotonOrigins."""

    _find = ComputeShader("photons/photon_groups/find.comp")

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """BufferSet.is_needed: where light groups have passes."""
        return bool(sizes.light_groups)

    def find(self, context: StageContext, rays: moderngl.Buffer, origins: moderngl.Buffer, photons: int) -> None:
        """Enter the groups of so many photons, whose rays (RAY) have just left the lights, into their PHOTON_ORIGIN."""
        if not self.is_on:
            return
        self._find.run(
            photons,
            {**context.blocks, "Rays": rays, "PhotonOrigins": origins},
            {"count": photons},
        )
