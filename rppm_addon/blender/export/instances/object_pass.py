# SPDX-License-Identifier: GPL-3.0-or-later
"""One pass over the instances of a depsgraph."""

from collections.abc import Callable, Iterator

import bpy
import numpy as np

from ....scene import Instance
from ..camera.culling import Selection
from ..common.report import Report
from ..context import ExportContext
from ..shading.nodes.material_table import MaterialTable
from .converted_curves import ConvertedCurves
from .instance_reader import InstanceReader
from .mesh_table import MeshTable
from .multiplied_objects import MultipliedObjects
from .object_hair import ObjectHair
from .object_matrices import instance_matrices
from .particles import ParticleTable
from .placements import Placed, Placements
from .single_objects import SingleObjects

_AT_ONCE = 32
"""Instances between which nobody looks at the clock."""


class InstanceWalk:
    """A walk over the entries of ``depsgraph.object_instances``, in slices that each go on where the last ended."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._matrices: np.ndarray | None = None
        self.done = 0
        """Number of entries that have been dealt with."""
        self.count = 0
        """Number of all entries; 0 before the first slice."""

    def entries(
        self, depsgraph: bpy.types.Depsgraph
    ) -> Iterator[tuple[bpy.types.DepsgraphObjectInstance, bpy.types.Object, np.ndarray]]:
        """Yield each entry that was not dealt with, its evaluated object and its matrix (4, 4), object to world.

        An entry counts as dealt with when the next is asked for, and is valid only until then, as Blender reuses its
        memory. Raises Unfinished when the slice is over, and ExportStopped.
        """
        if self._matrices is None:
            self._matrices = instance_matrices(depsgraph)
            self.count = len(self._matrices)
        if self.done == self.count:
            return
        start, slices, matrices = self.done, self._report.slices, self._matrices
        for number, entry in enumerate(depsgraph.object_instances):
            if number < start:  # Blender's iterator is nothing to be held from one slice to the next
                continue
            if number == start:
                slices.restart()
            if number % _AT_ONCE == 0 and number > start:
                slices.rest()
                self._report.progress(f"Exporting objects ({number})")
            yield entry, entry.object, matrices[number]
            self.done = number + 1
        self.done = self.count


class ObjectPass:
    """Places the instances and lights of a depsgraph. Between two slices of it nothing of Blender is held."""

    def __init__(
        self,
        context: ExportContext,
        materials: MaterialTable,
        meshes: MeshTable,
        unchanged: dict[int, Instance],
        moved: dict[int, Instance],
        identify: bool,
    ) -> None:
        """unchanged: by session_uid, the instances of objects that stand for themselves and are as they were; moved: of
        objects that at most were moved. identify: whether identities are recorded."""
        self._context = context
        self._materials = materials
        self._meshes = meshes
        self._begin(unchanged, moved, identify)

    def _begin(self, unchanged: dict[int, Instance], moved: dict[int, Instance], identify: bool) -> None:
        context, report = self._context, self._context.report
        self._sampled = self._materials.sampled
        self.walk = InstanceWalk(report)
        self._reader = InstanceReader(context, self._materials, self._meshes)
        self._placements = Placements(identify)
        self._particles = ParticleTable()
        self._curves = ConvertedCurves(self._reader, self._placements)
        self._single = SingleObjects(self._reader, self._placements, self._curves, unchanged, moved)
        self._multiplied = MultipliedObjects(self._reader, self._placements, self._curves, self._particles)
        self._hair = ObjectHair(self._reader, self._placements, report, context.is_render)
        self._awaits_hair = False
        """Whether the next entry is placed, but for its hair."""

    def advance(self, depsgraph: bpy.types.Depsgraph, shown: Callable[[bpy.types.Object], bool] | None) -> Placed:
        """All instances and lights, of a depsgraph that is as it was when the pass began.

        shown: which of the original objects are to be seen, all if None. Raises Unfinished when the slice is over, to
        be called again, and ExportStopped when the user wants no more.
        """
        selection = Selection(self._context.culling, shown)
        self._place(depsgraph, selection)
        if self._sampled != self._materials.sampled:  # meshes that came before were not asked for it
            self._begin({}, {}, self._placements.identify)
            self._place(depsgraph, selection)
        report = self._context.report
        placed = self._placements.finish(report)
        self._reader.missing.warn(report)
        self._reader.faceless.warn(report)
        return placed

    def _place(self, depsgraph: bpy.types.Depsgraph, selection: Selection) -> None:
        """Place all that a slice has time for. Raises Unfinished when it is over."""
        use_surfaces, may_have_hair = self._context.filter.surfaces, self._context.may_have_hair
        self._reader.instance_attributes.depsgraph = depsgraph
        self._particles.begin(depsgraph.scene_eval.frame_current_final)
        try:
            for entry, source, matrix in self.walk.entries(depsgraph):
                if not use_surfaces and source.type != "LIGHT":
                    continue
                if not self._awaits_hair:
                    if entry.is_instance:
                        self._multiplied.export(entry, source, matrix, selection)
                    elif entry.show_self:
                        self._single.export(entry, source, matrix, selection)
                if may_have_hair and source.type == "MESH" and entry.show_particles:
                    self._awaits_hair = True
                    self._hair.export(entry, source, matrix, selection)
                    self._awaits_hair = False
            self._curves.export(depsgraph, self._context.report.slices)
        finally:
            self._reader.instance_attributes.depsgraph = None  # it may hold something of Blender's
            self._particles.forget()
            self._placements.check()
