# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects and materials of a scene that follows a depsgraph."""

from collections.abc import Callable

import bpy
import numpy as np

from ....scene import Instance
from ..common.slices import ExportProgress
from ..context import ExportContext
from ..instances.object_pass import ObjectPass
from ..instances.objects import ObjectExporter
from ..instances.placements import Placed
from ..omissions import OmissionList
from .edits import Edits, PendingEdits

_SHAPELESS = {"CAMERA", "ARMATURE", "LATTICE", "EMPTY", "SPEAKER", "LIGHT_PROBE"}
"""Objects that are not seen."""


class ObjectSync:
    """Exports objects and materials again where they have changed."""

    def __init__(self, context: ExportContext) -> None:
        self._context = context
        self.exporter = ObjectExporter(context)
        self._omissions = OmissionList()
        self._placed: Placed | None = None
        """Instances and lights that the newest scene has."""
        self._pass: ObjectPass | None = None
        """Pass over the objects that is under way to the next scene; None where there is none."""

    @property
    def progress(self) -> ExportProgress:
        """Progress of the pass that is under way."""
        return ExportProgress() if self._pass is None else ExportProgress(self._pass.walk.done, self._pass.walk.count)

    def end_pass(self) -> None:
        """End the pass that is under way, done or not."""
        self._pass = None

    def renew_materials(self, depsgraph: bpy.types.Depsgraph, edits: Edits, pending: PendingEdits) -> None:
        """Export the materials that have changed again."""
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
                pending.attributes |= self.exporter.materials.renew(known[uid])
            pending.materials.discard(uid)

    def update(
        self,
        depsgraph: bpy.types.Depsgraph,
        edits: Edits,
        pending: PendingEdits,
        shown: Callable[[bpy.types.Object], bool] | None,
    ) -> Placed:
        """All instances and lights, after renew_materials().

        shown: which of the original objects are to be seen, all if None. Raises Unfinished when the slice is over.
        """
        is_whole = self._placed is None or pending.others or pending.attributes or self._context.culling.is_used
        if is_whole or pending.objects != edits.objects.keys() or not self._patch(depsgraph, edits, pending):
            self._export_all(depsgraph, pending, shown)
        else:
            self._omissions.look_at(edits.objects.values())
        self._omissions.warn(depsgraph, self._context.report)
        return self._placed

    def _export_all(
        self,
        depsgraph: bpy.types.Depsgraph,
        pending: PendingEdits,
        shown: Callable[[bpy.types.Object], bool] | None,
    ) -> None:
        """Go through all instances."""
        if self._pass is None:
            unchanged, moved = ({}, {}) if pending.attributes else self._reusable(pending)
            self._pass = self.exporter.begin(unchanged, moved)
            self._omissions = OmissionList()
        placed = self.exporter.advance(self._pass, depsgraph, shown)
        self._omissions.look_at_all(depsgraph, self._context.report.slices)
        self._placed = placed

    def _reusable(self, pending: PendingEdits) -> tuple[dict[int, Instance], dict[int, Instance]]:
        """Instances of the objects that the depsgraph does not name, and of those that at most were moved."""
        if self._placed is None:
            return {}, {}
        instances, unchanged, moved = self._placed.instances, {}, {}
        for uid, place in self._placed.single_instances.items():
            if uid not in pending.objects:
                unchanged[uid] = instances[place]
            elif uid not in pending.looks:
                moved[uid] = instances[place]
        return unchanged, moved

    def _patch(self, depsgraph: bpy.types.Depsgraph, edits: Edits, pending: PendingEdits) -> bool:
        """Put changed objects in their places; False when that is not enough."""
        placed, changed, sampled = self._placed, [], self.exporter.materials.sampled
        for uid, source in edits.objects.items():
            if source.is_instancer or len(source.particle_systems) > 0:
                return False
            if uid in placed.single_instances:
                if uid in pending.shapes and any(modifier.type == "NODES" for modifier in source.modifiers):
                    return False  # they may bring instances
                changed.append(uid)
            elif uid in placed.single_lights:
                with self._context.report.about(("object", uid)):
                    light = self.exporter.light(source, np.array(source.matrix_world, np.float64))
                if light is None:
                    return False
                placed.lights[placed.single_lights[uid]] = light
            elif source.type not in _SHAPELESS:
                return False
        before = [None if uid in pending.looks else placed.instances[placed.single_instances[uid]] for uid in changed]
        instances = self.exporter.instances(depsgraph, [edits.objects[uid] for uid in changed], before)
        if sampled != self.exporter.materials.sampled:  # new materials ask for attributes of all meshes
            pending.attributes = True
            return False
        if any(instance is None for instance in instances):
            return False
        for uid, instance in zip(changed, instances, strict=True):
            placed.instances[placed.single_instances[uid]] = instance
        return True
