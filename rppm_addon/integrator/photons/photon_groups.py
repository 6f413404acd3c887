# SPDX-License-Identifier: GPL-3.0-or-later
"""Light groups of photons: those of the lights that they left."""

import moderngl

from ...gl.buffer_sets import BufferSet, ComputeShader, StorageBuffer
from ...gl.buffers.records import Record
from ..common.stage_sizes import StageSizes, photon_paths
from ..device_scene.stage_context import StageContext

Record("PhotonGroupParameters", count="uint")


class PhotonGroups(BufferSet):
    """Number of the light group of each photon, that of the light which it left."""

    remedy = "lower the photons per iteration"
    groups = StorageBuffer("light groups of photons", "uint", photon_paths, block="PhotonGroups")
    _find = ComputeShader("photons/photon_groups/find.comp")

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """BufferSet.is_needed: where light groups have passes."""
        return bool(sizes.light_groups)

    def find(self, context: StageContext, rays: moderngl.Buffer, photons: int) -> None:
        """Take the groups of so many photons, whose rays (RAY) have just left the lights."""
        if not self.is_on:
            return
        self._find.run(
            photons,
            {**context.blocks, **self.blocks, "Rays": rays},
            {"count": photons},
        )
