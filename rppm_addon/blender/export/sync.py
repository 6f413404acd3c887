# SPDX-License-Identifier: GPL-3.0-or-later
"""A Scene that follows a depsgraph which lives on: only what has changed is exported again."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np

from ...scene import Camera, Instance, Scene, World
from ...scene.garbage import collector_paused
from ...scene.lights import Light
from ...scene.sharing import share
from .context import ExportContext
from .layers import overrides_of, world_of
from .libraries import warn_of_missing
from .light_linking import LightLinks
from .lights.world import export_world
from .objects.assets import export_asset_names
from .objects.object_pass import Placed
from .objects.objects import ObjectExporter
from .omissions import OmissionList, objects_of
from .report import Report
from .settings import export_cubemap_center, export_exposure, export_settings

_MOST_UNUSED = 64
"""Images of frames gone by are kept up to so many."""
_FEW_NEW = 64
"""Objects that an update exports without being prepared for."""
_SHAPELESS = {"CAMERA", "ARMATURE", "LATTICE", "EMPTY", "SPEAKER", "LIGHT_PROBE"}
"""Objects that are not seen."""


@dataclass
class Edits:
    """What a depsgraph says has changed."""

    objects: dict[int, bpy.types.Object] = field(default_factory=dict)
    """Evaluated objects by session_uid."""
    shapes: set[int] = field(default_factory=set)
    """session_uid of the objects whose geometry has changed."""
    looks: set[int] = field(default_factory=set)
    """session_uid of the objects of which more may have changed than where they are, such as their materials."""
    materials: list[bpy.types.Material] = field(default_factory=list)
    world: bool = False
    images: bool = False
    others: bool = False
    """Whether objects may have come, gone or changed in other ways: all instances are listed anew."""


def read_edits(depsgraph: bpy.types.Depsgraph) -> Edits:
    """The updates of a depsgraph since it was last evaluated."""
    edits = Edits()
    shapes, looks = (_flags(depsgraph.updates, name) for name in ("is_updated_geometry", "is_updated_shading"))
    for number, update in enumerate(depsgraph.updates):
        block = update.id
        if isinstance(block, bpy.types.Object):
            uid = block.original.session_uid
            edits.objects[uid] = block
            if shapes[number]:
                edits.shapes.add(uid)
            if shapes[number] or looks[number]:
                edits.looks.add(uid)
        elif isinstance(block, bpy.types.Material):
            edits.materials.append(block)
        elif isinstance(block, bpy.types.World):
            edits.world = True
        elif isinstance(block, bpy.types.Image):
            edits.images = True
        elif not isinstance(block, _TOLD_BY_THEIR_USERS):
            edits.others = True
    edits.others |= not depsgraph.updates
    return edits


def _flags(updates: bpy.types.bpy_prop_collection, name: str) -> list[bool]:
    values = np.zeros(len(updates), bool)
    if len(values):
        updates.foreach_get(name, values)
    return values.tolist()


_TOLD_BY_THEIR_USERS = (
    bpy.types.NodeTree, bpy.types.Light, bpy.types.Camera, bpy.types.Mesh, bpy.types.Curve, bpy.types.MetaBall,
    bpy.types.Armature, bpy.types.Lattice, bpy.types.Key, bpy.types.Action,
)  # fmt: skip
"""Blocks with which Blender also names the objects or materials that they change."""


@dataclass(frozen=True)
class ExportProgress:
    """How far an export in parts is."""

    objects: int
    of: int


class SceneSync:
    """The scene of one depsgraph, of a viewport or of renders."""

    def __init__(self, viewport: bool = True, make_report: Callable[[], Report] = Report) -> None:
        """viewport: whose settings count. make_report: for what an export has to say and whether it goes on; one that
        it stops leaves nothing that can be updated."""
        self._viewport = viewport
        self._make_report = make_report
        self.scene: Scene | None = None
        """The newest, None before the first update. Scenes that were handed out are not changed."""
        self._begin()

    def _begin(self) -> None:
        self._report = self._make_report()
        warn_of_missing(self._report)
        self._context = ExportContext(self._report)
        self._images = self._context.images
        self._objects = ObjectExporter(self._context)
        self._omissions = OmissionList()
        self._placed: Placed | None = None
        self._prepared = 0
        """Instances whose meshes and materials are exported for the next update."""
        self._world: tuple[World, list[Light]] | None = None
        self._world_may_change = False
        self._most_images = 0
        self._frame: float | None = None
        self._overrides: tuple[object, ...] = ()
        """What the view layer made of the scene."""
        self._light_links = LightLinks()

    @collector_paused()
    def update(
        self, depsgraph: bpy.types.Depsgraph, camera: Camera, shown: Callable[[bpy.types.Object], bool] | None = None
    ) -> Scene:
        """Export what the depsgraph says has changed; the scene before if nothing did that is seen.

        shown: which original objects the viewport shows. Raises the errors of scene/errors.py.
        """
        edits, asked = self._take_edits(depsgraph)
        source = depsgraph.scene_eval
        if self._world is None:
            reads = self._context.untracked_reads
            with self._report.about("world"):
                self._world = export_world(world_of(depsgraph), self._context)
            self._world_may_change = self._context.untracked_reads > reads
        if self._placed is None or edits.others or asked or not self._patch(depsgraph, edits):
            unchanged, moved = ({}, {}) if asked else self._known(edits)
            self._placed = self._objects.export(depsgraph, shown, unchanged, moved)
            self._omissions = OmissionList()
            self._omissions.look_at(objects_of(depsgraph))
        else:
            self._omissions.look_at(edits.objects.values())
        self._omissions.tell(depsgraph, self._report)
        world, suns = self._world
        settings = export_settings(source, depsgraph.view_layer, self._viewport)
        settings.validate()
        new = Scene(
            camera=camera,
            meshes=list(self._objects.meshes.meshes),
            instances=list(self._placed.instances),
            materials=list(self._objects.materials.materials),
            lights=[*self._placed.lights, *suns],
            world=world,
            images=list(self._images.images),
            settings=settings,
            exposure=export_exposure(source),
            cubemap_center=export_cubemap_center(depsgraph),
            asset_names=export_asset_names(depsgraph, settings),
            warnings=self._report.warnings,
        )
        if self._most_images == 0:
            self._most_images = len(new.images) + _MOST_UNUSED
        self.scene = share(self.scene, new)
        return self.scene

    def prepare(
        self,
        depsgraph: bpy.types.Depsgraph,
        seconds: float,
        shown: Callable[[bpy.types.Object], bool] | None = None,
    ) -> ExportProgress | None:
        """Do a part of the work of an update that has many new objects to export, in about so many seconds.

        Returns how far it is, or None when all that is left is update(), which is to follow at once. Between two calls
        anything may change: nothing of Blender is held, and what changes is exported again.
        """
        end = time.monotonic() + seconds
        if self._placed is not None:
            count = len(depsgraph.object_instances)
            if count <= len(self._placed.instances) + len(self._placed.lights) + _FEW_NEW:
                return None
            self._placed = None  # what comes now is named once only, before update()
        with collector_paused():
            edits, _ = self._take_edits(depsgraph)
            changed = self._prepared == 0 or len(depsgraph.updates) > 0
            place = self._objects.prepare(depsgraph, shown, self._prepared, lambda: time.monotonic() >= end, changed)
        self._prepared = place or 0
        if place is None and not edits.images:  # with which an update begins anew
            return None
        return ExportProgress(self._prepared, len(depsgraph.object_instances))

    def _take_edits(self, depsgraph: bpy.types.Depsgraph) -> tuple[Edits, bool]:
        """What has changed, of which shapes are forgotten and materials exported again; and whether those ask for
        other attributes of meshes."""
        edits = read_edits(depsgraph)
        overrides = overrides_of(depsgraph)
        links = self._light_links
        if edits.others or edits.looks or any(source.type == "LIGHT" for source in edits.objects.values()):
            links = LightLinks(depsgraph.view_layer)
        known = overrides == self._overrides and links.state == self._light_links.state
        if edits.images or not known or 0 < self._most_images < len(self._images.images):
            self._begin()
            self._overrides, self._light_links = overrides, links
        self._context.read_from(depsgraph)
        self._context.light_links = self._light_links
        self._light_links.tell(self._report)
        self._advance(depsgraph.scene_eval, depsgraph, edits)
        # Not any(): each is to be exported.
        asked = [self._objects.materials.renew(material) for material in edits.materials]
        self._objects.meshes.forget(edits.shapes)
        if edits.world:
            self._world = None
        return edits, any(asked)

    def _advance(self, source: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, edits: Edits) -> None:
        """Add what the depsgraph does not tell: of another frame image sequences show other images, and materials may
        read properties of the scene."""
        frame = source.frame_current_final
        edits.others |= self._frame not in {None, frame}
        if edits.others:
            known = {material.original.session_uid for material in edits.materials}
            edits.materials += [
                material.evaluated_get(depsgraph)
                for material in bpy.data.materials
                if material.session_uid not in known and self._objects.materials.may_have_changed(material)
            ]
            edits.world |= self._world_may_change
        self._frame = frame

    def _known(self, edits: Edits) -> tuple[dict[int, Instance], dict[int, Instance]]:
        """Instances of the objects that the depsgraph does not name, and of those that at most were moved."""
        if self._placed is None:
            return {}, {}
        instances, alone = self._placed.instances, self._placed.alone
        unchanged, moved = {}, {}
        for uid, place in alone.items():
            if uid not in edits.objects:
                unchanged[uid] = instances[place]
            elif uid not in edits.looks:
                moved[uid] = instances[place]
        return unchanged, moved

    def _patch(self, depsgraph: bpy.types.Depsgraph, edits: Edits) -> bool:
        """Put changed objects in their places; False when that is not enough."""
        placed, changed = self._placed, []
        for uid, source in edits.objects.items():
            if source.is_instancer or len(source.particle_systems) > 0:
                return False
            if uid in placed.alone:
                if uid in edits.shapes and any(modifier.type == "NODES" for modifier in source.modifiers):
                    return False  # they may bring instances
                changed.append(uid)
            elif uid in placed.lights_alone:
                with self._report.about(("object", uid)):
                    light = self._objects.light(source, np.array(source.matrix_world, np.float64))
                if light is None:
                    return False
                placed.lights[placed.lights_alone[uid]] = light
            elif source.type not in _SHAPELESS:
                return False
        before = [None if uid in edits.looks else placed.instances[placed.alone[uid]] for uid in changed]
        instances = self._objects.instances(depsgraph, [edits.objects[uid] for uid in changed], before)
        if any(instance is None for instance in instances):
            return False
        for uid, instance in zip(changed, instances, strict=True):
            placed.instances[placed.alone[uid]] = instance
        return True
