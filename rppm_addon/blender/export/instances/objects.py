# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects of a depsgraph, instances included: meshes, placements and lights."""

from collections.abc import Callable

import bpy
import numpy as np

from ....scene import Instance, Light
from ..common.matrices import usable_matrices
from ..context import ExportContext
from .instance_reader import InstanceReader
from .object_matrices import matrices_of
from .object_pass import ObjectPass, Placed


class ObjectExporter:
    """Reads a depsgraph's objects; meshes and materials that it knows are not exported again."""

    def __init__(self, context: ExportContext) -> None:
        self._reader = InstanceReader(context)
        self.materials = self._reader.materials
        self.meshes = self._reader.meshes
        self._report = context.report

    def export(
        self,
        depsgraph: bpy.types.Depsgraph,
        shown: Callable[[bpy.types.Object], bool] | None = None,
        unchanged: dict[int, Instance] | None = None,
        moved: dict[int, Instance] | None = None,
        identify: bool = False,
    ) -> Placed:
        """All instances and lights.

        shown: which of the original objects are to be seen, all if None. unchanged: by session_uid, the instances of
        objects that stand for themselves and are as they were; moved: of those that at most were moved. identify: tell
        by what they are known at other times. Raises ExportStopped when the user wants no more.
        """
        return self.go_on(self.begin(unchanged, moved, identify), depsgraph, shown)

    def begin(
        self,
        unchanged: dict[int, Instance] | None = None,
        moved: dict[int, Instance] | None = None,
        identify: bool = False,
    ) -> ObjectPass:
        """An export that takes more than one slice, for go_on(); of passes that were begun the last goes on."""
        self.meshes.begin_pass()
        self._reader.begin_pass()
        return ObjectPass(self._reader, unchanged or {}, moved or {}, identify)

    def go_on(
        self,
        objects: ObjectPass,
        depsgraph: bpy.types.Depsgraph,
        shown: Callable[[bpy.types.Object], bool] | None = None,
    ) -> Placed:
        """Return the result of export() for a depsgraph in which nothing has changed since the pass was begun.

        Raises Unfinished when the slice is over, and ExportStopped.
        """
        with self._report.about("objects", goes_on=objects.place > 0):
            placed = objects.go_on(depsgraph, shown)
        self.meshes.end_pass()
        return placed

    def instances(
        self, depsgraph: bpy.types.Depsgraph, sources: list[bpy.types.Object], before: list[Instance | None]
    ) -> list[Instance | None]:
        """The instances of mesh objects that stand for themselves alone; None of one that is not to be rendered.

        before: of those that at most were moved, the instances that they had.
        """
        self._reader.begin_pass()
        matrices, usable = usable_matrices(matrices_of(depsgraph, sources))
        return [
            self._reader.instance(source, matrix, known) if good else None
            for source, matrix, good, known in zip(sources, matrices, usable.tolist(), before, strict=True)
        ]

    def light(self, source: bpy.types.Object, matrix: np.ndarray) -> Light | None:
        """A light object placed by a matrix (4, 4); None when it gives no light."""
        return self._reader.light(source, matrix)
