# SPDX-License-Identifier: GPL-3.0-or-later
"""One pass over the instances of a depsgraph."""

import itertools
from collections.abc import Callable, Iterator

import bpy
import numpy as np

from ....scene import Instance
from ..camera.culling import Selection
from ..common.report import Report
from ..context import ExportContext
from ..shading.nodes.material_table import MaterialTable
from .converted_curves import ConvertedCurves
from .instance_groups import InstanceGroups
from .instance_reader import InstanceReader
from .mesh_table import MeshTable
from .multiplied_objects import MultipliedObjects
from .object_hair import ObjectHair
from .object_matrices import instance_matrices
from .particles import ParticleTable
from .placements import Placed, Placements
from .single_objects import SingleObjects

_AT_ONCE = 128
"""Entries between which nobody looks at the clock."""


class InstanceWalk:
    """A walk over the entries of ``depsgraph.object_instances``, in slices that each go on where the last ended."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self.matrices = np.zeros((0, 4, 4), np.float32)
        """(entries, 4, 4) float32, object to world."""
        self._is_begun = False
        self._exact, self._exact_start = self.matrices, 0
        """Some matrices that follow each other, float64, and the number of the first."""
        self.done = 0
        """Number of entries that have been dealt with."""
        self.count = 0
        """Number of all entries; 0 before the first slice."""

    def chunks(
        self, depsgraph: bpy.types.Depsgraph
    ) -> Iterator[Iterator[tuple[int, bpy.types.DepsgraphObjectInstance]]]:
        """Yield the entries that were not dealt with, some at a time, each with its number.

        Entries count as dealt with when the next ones are asked for. An entry is valid only until the next, as Blender
        reuses its memory. Raises Unfinished when the slice is over, and ExportStopped.
        """
        if not self._is_begun:
            self.matrices, self._is_begun = instance_matrices(depsgraph), True
            self.count = len(self.matrices)
        if self.done == self.count:
            return
        slices = self._report.slices
        # Blender's iterator is nothing to be held from one slice to the next: it goes to the place again.
        entries = enumerate(itertools.islice(depsgraph.object_instances, self.done, None), self.done)
        first = next(entries)
        slices.restart()
        chunk = itertools.chain((first,), itertools.islice(entries, _AT_ONCE - 1))
        while self.done < self.count:
            end = min(self.done + _AT_ONCE, self.count)
            yield chunk
            self.done = end
            slices.rest()
            self._report.progress(f"Exporting objects ({end})")
            chunk = itertools.islice(entries, _AT_ONCE)

    def matrix(self, number: int) -> np.ndarray:
        """The matrix (4, 4) float64 of the entry of a number, object to world."""
        place = number - self._exact_start
        if not 0 <= place < len(self._exact):
            self._exact, self._exact_start = self.matrices[number : number + _AT_ONCE].astype(np.float64), number
            place = 0
        return self._exact[place]


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
        self._may_have_hair = context.may_have_hair
        self._sampled = self._materials.sampled
        self.walk = InstanceWalk(report)
        self._reader = InstanceReader(context, self._materials, self._meshes)
        self._placements = Placements(identify)
        self._particles = ParticleTable()
        self._curves = ConvertedCurves(self._reader, self._placements)
        self._single = SingleObjects(self._reader, self._placements, self._curves, unchanged, moved)
        self._groups = InstanceGroups(self._placements, self._reader.missing)
        self._multiplied = MultipliedObjects(
            self._reader, self._placements, self._curves, self._particles, self._groups, self._may_have_hair
        )
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
        placed = self._placements.finish(report, self._groups.arrays())
        self._reader.missing.warn(report)
        self._reader.faceless.warn(report)
        return placed

    def _place(self, depsgraph: bpy.types.Depsgraph, selection: Selection) -> None:
        """Place all that a slice has time for. Raises Unfinished when it is over."""
        use_surfaces = self._context.filter.surfaces
        self._reader.instance_attributes.depsgraph = depsgraph
        self._particles.begin(depsgraph.scene_eval.frame_current_final)
        try:
            for entries in self.walk.chunks(depsgraph):
                for number, entry in self._groups.others(entries):
                    self.walk.done = number
                    if use_surfaces or entry.object.type == "LIGHT":
                        self._export(number, entry, selection)
            self._placements.begin_entry(self.walk.count)
            self._curves.export(depsgraph, self._context.report.slices)
        finally:
            self._groups.settle(self.walk.matrices)
            self._reader.instance_attributes.depsgraph = None  # it may hold something of Blender's
            self._particles.forget()
            self._placements.check()

    def _export(self, number: int, entry: bpy.types.DepsgraphObjectInstance, selection: Selection) -> None:
        """Place what an entry of a number shows. Raises Unfinished when the slice is over."""
        source, matrix = entry.object, self.walk.matrix(number)
        self._placements.begin_entry(number)
        if not self._awaits_hair:
            if entry.is_instance:
                self._multiplied.export(number, entry, source, matrix, selection)
            elif entry.show_self:
                self._single.export(entry, source, matrix, selection)
        if self._may_have_hair and source.type == "MESH" and entry.show_particles:
            self._awaits_hair = True
            self._hair.export(entry, source, matrix, selection)
            self._awaits_hair = False
