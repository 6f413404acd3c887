# SPDX-License-Identifier: GPL-3.0-or-later
"""The export of a viewport's scene, in slices that let Blender go on between them."""

import math

import bpy

from ...scene import Scene
from ..export import ExportProgress, SceneSync, export_view
from ..export.common.slices import SlicePacing
from . import kept_exports


class ViewportExport:
    """Keeps the exported scene of a viewport up to date with its depsgraph."""

    def __init__(self) -> None:
        self._sync = SceneSync()
        self._pacing = SlicePacing()
        self._depsgraph_key: tuple | None = None
        """Key of the exported depsgraph (kept_exports.key_of); None before the first export."""
        self._visibility: tuple = ()
        """Local view and local collections, which hide objects without an update of the depsgraph."""
        self.progress: ExportProgress | None = None
        """Progress of an export that takes several slices; None when there is none."""

    @property
    def scene(self) -> Scene | None:
        """The scene that was exported last; None before the first export is complete."""
        return self._sync.scene

    def advance(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> bool:
        """Export a slice of what the depsgraph has changed. Returns whether ``scene`` is up to date.

        Raises RppmError where the scene cannot be rendered.
        """
        space = context.space_data

        def shown(source: bpy.types.Object) -> bool:
            return source.visible_in_viewport_get(space)

        self.progress = None
        camera = export_view(context, depsgraph)
        self._reuse_kept(depsgraph)
        visibility = space.local_view is not None, space.use_local_collections
        if visibility != self._visibility:
            self._visibility = visibility
            self._sync.relist()
        seconds = self._pacing.begin(is_first=self._sync.scene is None)
        if is_playing(context) and self._sync.scene is not None:
            seconds = math.inf
        try:
            self.progress = self._sync.advance(depsgraph, camera, shown, seconds)
        finally:
            self._pacing.end(is_last=self.progress is None)
        return self.progress is None

    def _reuse_kept(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Continue with the export that another viewport of the depsgraph has left."""
        key = kept_exports.key_of(depsgraph)
        if key == self._depsgraph_key:
            return
        self.keep()
        self._depsgraph_key, self._visibility = key, ()
        self._sync = kept_exports.take(depsgraph) or SceneSync()

    def keep(self) -> None:
        """Leave the export to the next viewport of the depsgraph."""
        if self._depsgraph_key is not None:
            kept_exports.keep(self._depsgraph_key, self._sync)


def is_playing(context: bpy.types.Context) -> bool:
    """Return whether Blender plays an animation in the window of a context."""
    return context.screen is not None and context.screen.is_animation_playing
