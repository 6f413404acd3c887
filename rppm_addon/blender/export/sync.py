# SPDX-License-Identifier: GPL-3.0-or-later
"""A Scene that follows a depsgraph which lives on: only what has changed is exported again."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np

from ...scene import Camera, Instance, Scene, World
from ...scene.garbage import collector_paused
from ...scene.lights import Light
from ...scene.sharing import share
from .context import ExportContext
from .culling import Culling
from .curve_settings import curve_settings
from .images.texture_limit import texture_limit
from .layers import overrides_of, world_of
from .libraries import warn_of_missing
from .light_linking import LightLinks
from .lights.world import export_world
from .objects.assets import export_asset_names
from .objects.object_pass import ObjectPass
from .objects.objects import ObjectExporter
from .objects.placements import Placed
from .omissions import OmissionList
from .report import Report
from .settings import export_cubemap_center, export_dicing_rate, export_exposure, export_settings
from .slices import Unfinished

_MOST_UNUSED = 64
"""Images of frames gone by are kept up to so many."""
_PATIENCE = 1.5
"""Slices take longer by this factor each time that something changes before an export is done."""
_SHAPELESS = {"CAMERA", "ARMATURE", "LATTICE", "EMPTY", "SPEAKER", "LIGHT_PROBE"}
"""Objects that are not seen."""


@dataclass
class Edits:
    """Changes that a depsgraph reports."""

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
    """How far an export in slices is."""

    objects: int = 0
    of: int = 0
    """0 as long as there is more to be done before objects."""


@dataclass
class _Pending:
    """Changes since the newest scene, by session_uid: nothing of Blender is held."""

    objects: set[int] = field(default_factory=set)
    shapes: set[int] = field(default_factory=set)
    looks: set[int] = field(default_factory=set)
    materials: set[int] = field(default_factory=set)
    others: bool = False
    attributes: bool = False
    """Whether materials ask for other attributes than before."""
    has_untracked: bool = False
    """Whether materials that rest on what the depsgraph does not tell are among them."""


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
        self._context = ExportContext(self._report, self._viewport)
        self._images = self._context.images
        self._objects = ObjectExporter(self._context)
        self._omissions = OmissionList()
        self._placed: Placed | None = None
        """Instances and lights that the newest scene has."""
        self._pass: ObjectPass | None = None
        """Pass over the objects that is under way to the next scene; None where there is none."""
        self._pending = _Pending()
        self._is_unfinished = False
        """Whether an export is under way."""
        self._delays = 0
        """How often something has changed meanwhile."""
        self._world: tuple[World, list[Light]] | None = None
        self._world_may_change = False
        self._most_images = 0
        self._frame: float | None = None
        self._overrides: tuple[object, ...] = ()
        """Effects of the view layer on the scene (overrides_of), the texture limit and the curve settings."""
        self._light_links = LightLinks()
        self._culling: tuple[object, ...] = ()
        """Culling.state."""

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
        overrides = (
            *overrides_of(depsgraph),
            texture_limit(depsgraph.scene_eval, self._viewport),
            curve_settings(depsgraph),
        )
        if overrides != self._overrides or 0 < self._most_images < len(self._images.images):
            self._begin()
        edits = self.note(depsgraph)
        self._link_lights(depsgraph, edits)
        self._overrides = overrides
        slices = self._report.slices
        slices.begin(seconds * _PATIENCE**self._delays)
        try:
            self._export(depsgraph, camera, edits, shown)
        except Unfinished:
            self._is_unfinished = True
            return (
                ExportProgress() if self._pass is None else ExportProgress(self._pass.walk.done, self._pass.walk.count)
            )
        except BaseException:
            self._pass = None
            raise
        finally:
            slices.begin(math.inf)
        self._pass, self._pending, self._delays, self._is_unfinished = None, _Pending(), 0, False
        return None

    def note(self, depsgraph: bpy.types.Depsgraph) -> Edits:
        """Remember what a depsgraph says has changed, for the next scene."""
        edits = read_edits(depsgraph)
        if edits.images:
            self._begin()
        if len(depsgraph.updates) and self._is_unfinished:
            self.relist()
            self._delays += 1
        self._objects.meshes.forget(edits.shapes)
        if edits.world:
            self._world = None
        pending = self._pending
        pending.objects |= edits.objects.keys()
        pending.shapes |= edits.shapes
        pending.looks |= edits.looks
        pending.materials |= {material.original.session_uid for material in edits.materials}
        pending.others |= edits.others
        pending.has_untracked &= not len(depsgraph.updates)
        return edits

    def _link_lights(self, depsgraph: bpy.types.Depsgraph, edits: Edits) -> None:
        """See what lights are linked with, and begin anew where that has changed."""
        pending = self._pending
        if len(depsgraph.updates) or not self._is_unfinished:
            noted_before = not pending.objects <= edits.objects.keys()
            has_lights = any(source.type == "LIGHT" for source in edits.objects.values())
            if pending.others or pending.looks or noted_before or has_lights:
                links = LightLinks(depsgraph.view_layer)
                if links.state != self._light_links.state:
                    self._begin()
                self._light_links = links
        self._context.light_links = self._light_links
        self._light_links.tell(self._report)

    def relist(self) -> None:
        """Begin anew with the objects, of which others may be shown."""
        self._pass = None
        self._pending.others = True

    def _export(
        self,
        depsgraph: bpy.types.Depsgraph,
        camera: Camera,
        edits: Edits,
        shown: Callable[[bpy.types.Object], bool] | None,
    ) -> None:
        """Bring ``scene`` up to date. Raises Unfinished when the slice is over."""
        source = depsgraph.scene_eval
        self._context.read_from(depsgraph)
        culling = self._context.culling = Culling() if self._viewport else Culling(source, camera)
        if culling.state != self._culling:
            self._culling = culling.state
            self.relist()
        self._add_untracked(source.frame_current_final)
        self._renew_materials(depsgraph, edits)
        if self._world is None:
            reads = self._context.untracked_reads
            with self._report.about("world"):
                self._world = export_world(world_of(depsgraph), self._context)
            self._world_may_change = self._context.untracked_reads > reads
        pending = self._pending
        lists = self._placed is None or pending.others or pending.attributes or pending.objects != edits.objects.keys()
        lists |= culling.is_used
        if lists or not self._patch(depsgraph, edits):
            self._list(depsgraph, shown)
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
            dicing_rate=export_dicing_rate(source, self._viewport),
            cubemap_center=export_cubemap_center(depsgraph),
            asset_names=export_asset_names(depsgraph, settings),
            warnings=self._report.warnings,
        )
        if self._most_images == 0:
            self._most_images = len(new.images) + _MOST_UNUSED
        self.scene = share(self.scene, new)

    def _add_untracked(self, frame: float) -> None:
        """Add what the depsgraph does not tell: of another frame image sequences show other images, and materials may
        read properties of the scene."""
        pending = self._pending
        pending.others |= self._frame not in {None, frame}
        self._frame = frame
        if pending.others and not pending.has_untracked:
            pending.has_untracked = True
            pending.materials |= self._objects.materials.untracked
            if self._world_may_change:
                self._world = None

    def _renew_materials(self, depsgraph: bpy.types.Depsgraph, edits: Edits) -> None:
        pending = self._pending
        if not pending.materials:
            return
        known = {material.original.session_uid: material for material in edits.materials}
        if not pending.materials <= known.keys():
            known |= {
                material.session_uid: material.evaluated_get(depsgraph)
                for material in bpy.data.materials
                if material.session_uid in pending.materials and material.session_uid not in known
            }
        for uid in sorted(pending.materials):
            if uid in known:
                pending.attributes |= self._objects.materials.renew(known[uid])
            pending.materials.discard(uid)

    def _list(self, depsgraph: bpy.types.Depsgraph, shown: Callable[[bpy.types.Object], bool] | None) -> None:
        """Go through all instances."""
        if self._pass is None:
            unchanged, moved = ({}, {}) if self._pending.attributes else self._known()
            self._pass = self._objects.begin(unchanged, moved)
            self._omissions = OmissionList()
        placed = self._objects.advance(self._pass, depsgraph, shown)
        self._omissions.look_at_all(depsgraph, self._report.slices)
        self._placed = placed

    def _known(self) -> tuple[dict[int, Instance], dict[int, Instance]]:
        """Instances of the objects that the depsgraph does not name, and of those that at most were moved."""
        if self._placed is None:
            return {}, {}
        instances, pending = self._placed.instances, self._pending
        unchanged, moved = {}, {}
        for uid, place in self._placed.single_instances.items():
            if uid not in pending.objects:
                unchanged[uid] = instances[place]
            elif uid not in pending.looks:
                moved[uid] = instances[place]
        return unchanged, moved

    def _patch(self, depsgraph: bpy.types.Depsgraph, edits: Edits) -> bool:
        """Put changed objects in their places; False when that is not enough."""
        placed, changed, sampled = self._placed, [], self._objects.materials.sampled
        for uid, source in edits.objects.items():
            if source.is_instancer or len(source.particle_systems) > 0:
                return False
            if uid in placed.single_instances:
                if uid in self._pending.shapes and any(modifier.type == "NODES" for modifier in source.modifiers):
                    return False  # they may bring instances
                changed.append(uid)
            elif uid in placed.single_lights:
                with self._report.about(("object", uid)):
                    light = self._objects.light(source, np.array(source.matrix_world, np.float64))
                if light is None:
                    return False
                placed.lights[placed.single_lights[uid]] = light
            elif source.type not in _SHAPELESS:
                return False
        before = [
            None if uid in self._pending.looks else placed.instances[placed.single_instances[uid]] for uid in changed
        ]
        instances = self._objects.instances(depsgraph, [edits.objects[uid] for uid in changed], before)
        if sampled != self._objects.materials.sampled:  # new materials ask for attributes of all meshes
            self._pending.attributes = True
            return False
        if any(instance is None for instance in instances):
            return False
        for uid, instance in zip(changed, instances, strict=True):
            placed.instances[placed.single_instances[uid]] = instance
        return True
