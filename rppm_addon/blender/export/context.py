# SPDX-License-Identifier: GPL-3.0-or-later
"""What all parts of an export share."""

from dataclasses import dataclass, field

import bpy

from .images.images import ImageTable
from .report import Report


@dataclass
class ExportContext:
    """Where warnings and images go, and what is the same for all that is exported."""

    report: Report
    images: ImageTable = field(default_factory=ImageTable)
    owners: tuple[bpy.types.bpy_struct | None, ...] = ()
    """View layer, scene and world, in the order in which they are asked for attributes."""
    owner_reads: int = 0
    """How often an attribute was read from the owners."""

    @property
    def untracked_reads(self) -> int:
        """How often something was read that changes without the depsgraph telling."""
        return self.owner_reads + self.images.reads_by_frame

    def read_from(self, depsgraph: bpy.types.Depsgraph) -> None:
        """What follows comes from this depsgraph, as it is now."""
        scene = depsgraph.scene_eval
        self.images.frame = scene.frame_current
        self.owners = (depsgraph.view_layer_eval, scene, scene.world)
