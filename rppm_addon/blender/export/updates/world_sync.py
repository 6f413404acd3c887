# SPDX-License-Identifier: GPL-3.0-or-later
"""The world of a scene that follows a depsgraph."""

import bpy

from ....scene import World
from ....scene.lights import Light
from ..context import ExportContext
from ..shading.lights.world import export_world
from ..view_layer.layers import world_of


class WorldSync:
    """Exports the world again where it has changed."""

    def __init__(self, context: ExportContext) -> None:
        self._context = context
        self._world: tuple[World, list[Light]] | None = None
        self._reads_untracked = False
        """Whether the world rests on what changes without the depsgraph reporting it."""

    def forget(self) -> None:
        """Forget the world, because it has changed."""
        self._world = None

    def forget_untracked(self) -> None:
        """Forget the world if it rests on what may have changed without the depsgraph reporting it."""
        if self._reads_untracked:
            self._world = None

    def update(self, depsgraph: bpy.types.Depsgraph) -> tuple[World, list[Light]]:
        """The environment, and the suns of its skies."""
        if self._world is None:
            reads = self._context.untracked_reads
            with self._context.report.about("world"):
                self._world = export_world(world_of(depsgraph), self._context)
            self._reads_untracked = self._context.untracked_reads > reads
        return self._world
