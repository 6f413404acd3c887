# SPDX-License-Identifier: GPL-3.0-or-later
"""A Scene that follows a depsgraph which lives on: only what has changed is exported again."""

import dataclasses
import math
from collections.abc import Callable

import bpy

from ....scene import Camera, Scene
from ....scene.common.garbage import collector_paused
from ....scene.storage.sharing import share
from ..camera.culling import Culling
from ..common.report import Report
from ..common.slices import ExportProgress, Unfinished
from ..context import ExportContext
from ..geometry.strands.curve_settings import curve_settings
from ..images.color_spaces import working_space
from ..images.texture_limit import texture_limit
from ..view_layer.layers import overrides_of
from ..view_layer.light_linking import LightLinks
from ..view_layer.settings import export_settings
from .assembly import fill_scene
from .edits import Edits, PendingEdits, read_edits
from .libraries import warn_of_missing
from .object_sync import ObjectSync
from .world_sync import WorldSync

_MOST_UNUSED = 64
"""Images of frames gone by are kept up to so many."""
_PATIENCE = 1.5
"""Slices take longer by this factor each time that something changes before an export is done."""


class SceneSync:
    """The scene of one depsgraph, of a viewport or of renders."""

    def __init__(self, viewport: bool = True, make_report: Callable[[], Report] = Report) -> None:
        """viewport: whose settings count. make_report: for what an export has to say and whether it goes on; one that
        it stops leaves nothing that can be updated."""
        self._viewport = viewport
        self._make_report = make_report
        self.scene: Scene | None = None
        """The newest, None before the first update. Scenes that were handed out are not changed."""
        self._overrides: tuple[object, ...] = ()
        """Effects of the view layer on the scene (overrides_of), the texture limit and the curve settings."""
        self._begin()

    def _begin(self) -> None:
        """Forget all that was exported."""
        report = self._make_report()
        warn_of_missing(report)
        self._context = ExportContext(report, self._viewport)
        self._objects = ObjectSync(self._context)
        self._world = WorldSync(self._context)
        self._pending = PendingEdits()
        self._is_unfinished = False
        """Whether an export is under way."""
        self._delays = 0
        """Number of times that something changed while the export was under way."""
        self._most_images = 0
        self._frame: float | None = None

    def update(
        self, depsgraph: bpy.types.Depsgraph, camera: Camera, shown: Callable[[bpy.types.Object], bool] | None = None
    ) -> Scene:
        """Export what the depsgraph says has changed; the scene before if nothing did that is seen.

        shown: which original objects the viewport shows. Raises the errors of scene/errors.py.
        """
        self.advance(depsgraph, camera, shown)
        return self.scene

    @collector_paused()
    def advance(
        self,
        depsgraph: bpy.types.Depsgraph,
        camera: Camera,
        shown: Callable[[bpy.types.Object], bool] | None = None,
        seconds: float = math.inf,
    ) -> ExportProgress | None:
        """Do what update() does, or as much of it as goes into about so many seconds.

        Returns None once ``scene`` is what update() gives. Before, it is what it was, and there is more to be done: to
        be called again, with a depsgraph that is up to date. Between two calls anything may change: nothing of Blender
        is held, and what changes is exported again.
        """
        self._follow_overrides(depsgraph)
        edits = self.note(depsgraph)
        self._link_lights(depsgraph, edits)
        slices = self._context.report.slices
        slices.begin(seconds * _PATIENCE**self._delays)
        try:
            self._export(depsgraph, camera, edits, shown)
        except Unfinished:
            self._is_unfinished = True
            return self._objects.progress
        except BaseException:
            self._objects.end_pass()
            raise
        finally:
            slices.begin(math.inf)
        self._objects.end_pass()
        self._pending, self._delays, self._is_unfinished = PendingEdits(), 0, False
        return None

    def _follow_overrides(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Begin anew where the view layer changes the scene in another way, or too many images are not used."""
        before = self._overrides
        limit = texture_limit(depsgraph.scene_eval, self._viewport)
        self._overrides = (*overrides_of(depsgraph), limit, curve_settings(depsgraph), working_space().name)
        if self._overrides != before or 0 < self._most_images < len(self._context.images.images):
            self._begin()

    def note(self, depsgraph: bpy.types.Depsgraph) -> Edits:
        """Remember what a depsgraph says has changed, for the next scene."""
        edits = read_edits(depsgraph)
        if edits.images:
            self._begin()
        if len(depsgraph.updates) and self._is_unfinished:
            self.relist()
            self._delays += 1
        self._objects.exporter.meshes.forget(edits.shapes)
        if edits.world:
            self._world.forget()
        self._pending.add(edits)
        self._pending.has_untracked &= not len(depsgraph.updates)
        return edits

    def relist(self) -> None:
        """Begin anew with the objects, of which others may be shown."""
        self._objects.end_pass()
        self._pending.others = True

    def _link_lights(self, depsgraph: bpy.types.Depsgraph, edits: Edits) -> None:
        """See what lights are linked with, and begin anew where that has changed."""
        pending = self._pending
        if len(depsgraph.updates) or not self._is_unfinished:
            noted_before = not pending.objects <= edits.objects.keys()
            has_lights = any(source.type == "LIGHT" for source in edits.objects.values())
            if pending.others or pending.looks or noted_before or has_lights:
                links = LightLinks(depsgraph.view_layer)
                if links.state != self._context.light_links.state:
                    self._begin()
                self._context.light_links = links
        self._context.light_links.warn(self._context.report)

    def _export(
        self,
        depsgraph: bpy.types.Depsgraph,
        camera: Camera,
        edits: Edits,
        shown: Callable[[bpy.types.Object], bool] | None,
    ) -> None:
        """Bring ``scene`` up to date. Raises Unfinished when the slice is over."""
        source, context = depsgraph.scene_eval, self._context
        context.read_from(depsgraph)
        self._cull(Culling() if self._viewport else Culling(source, camera))
        if not self._is_unfinished:
            self._forget_outdated()
        context.images.advance()
        self._add_untracked(source.frame_current_final)
        self._objects.renew_materials(depsgraph, edits, self._pending)
        world, suns = self._world.update(depsgraph)
        placed = self._objects.update(depsgraph, edits, self._pending, shown)
        context.images.finish()
        settings = export_settings(source, depsgraph.view_layer, self._viewport)
        settings.validate()
        new = Scene(camera=camera, settings=settings, world=world)
        fill_scene(new, depsgraph, context, self._objects.exporter, placed, suns)
        if self._viewport:
            _keep_view_of_dicing(self.scene, new)
        if self._most_images == 0:
            self._most_images = len(new.images) + _MOST_UNUSED
        self.scene = share(self.scene, new)

    def _forget_outdated(self) -> None:
        """Forget the meshes that Blender is to divide more or less, as they are seen larger or smaller."""
        bases = self._context.base_meshes
        outdated = set() if bases is None else bases.outdated()
        if outdated:
            self.relist()
            self._objects.exporter.meshes.forget(outdated)
            for noted in (self._pending.objects, self._pending.shapes, self._pending.looks):
                noted.update(outdated)

    def _cull(self, culling: Culling) -> None:
        """Take what Simplify leaves out now."""
        if culling.state != self._context.culling.state:
            self.relist()
        self._context.culling = culling

    def _add_untracked(self, frame: float) -> None:
        """Add what the depsgraph does not report: of another frame image sequences show other images, and materials may
        read properties of the scene."""
        pending = self._pending
        pending.others |= self._frame not in {None, frame}
        self._frame = frame
        if pending.others and not pending.has_untracked:
            pending.has_untracked = True
            pending.materials |= self._objects.exporter.materials.untracked
            self._world.forget_untracked()


def _keep_view_of_dicing(before: Scene | None, after: Scene) -> None:
    """Have the view of the scene before divide the meshes, or that of this scene where any of them is new: as in
    Cycles, nothing is divided anew as the viewport is navigated."""
    if after.dicing_view.camera is not None:
        return
    known = set() if before is None else {id(mesh) for mesh in before.meshes}
    diced = [id(mesh) for mesh in after.meshes if mesh.dicing is not None]
    if diced:
        is_known = before is not None and before.dicing_view.camera is not None and known.issuperset(diced)
        camera = before.dicing_view.camera if is_known else after.camera
        after.dicing_view = dataclasses.replace(after.dicing_view, camera=camera)
