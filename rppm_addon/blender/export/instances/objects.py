# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects of a depsgraph, instances included: meshes, placements and lights."""

from collections.abc import Callable

import bpy
import numpy as np

from ....scene import Instance, Light
from ..common.matrices import usable_matrices
from ..context import ExportContext
from ..shading.nodes.material_table import MaterialTable
from .instance_reader import InstanceReader
from .mesh_table import MeshTable
from .object_matrices import matrices_of
from .object_pass import ObjectPass
from .placements import Placed


class ObjectExporter:
    """Reads a depsgraph's objects; meshes and materials that it knows are not exported again."""

    def __init__(self, context: ExportContext) -> None:
        self.materials = MaterialTable(context)
        self.meshes = MeshTable(context)
        self._context = context

    def export(self, depsgraph: bpy.types.Depsgraph, identify: bool = False) -> Placed:
        """All instances and lights. identify: whether their identities are recorded.

        Raises ExportStopped when the user wants no more.
        """
        return self.advance(self.begin({}, {}, identify), depsgraph)

    def begin(self, unchanged: dict[int, Instance], moved: dict[int, Instance], identify: bool = False) -> ObjectPass:
        """Begin an export of more than one slice, for advance(); of passes that were begun, the last is advanced.

        unchanged: by session_uid, the instances of objects that stand for themselves and are as they were; moved: of
        objects that at most were moved. identify: whether identities are recorded.
        """
        self.meshes.begin_pass()
        return ObjectPass(self._context, self.materials, self.meshes, unchanged, moved, identify)

    def advance(
        self,
        objects: ObjectPass,
        depsgraph: bpy.types.Depsgraph,
        shown: Callable[[bpy.types.Object], bool] | None = None,
    ) -> Placed:
        """All instances and lights of a depsgraph in which nothing has changed since the pass was begun.

        shown: which of the original objects are to be seen, all if None. Raises Unfinished when the slice is over, and
        ExportStopped.
        """
        with self._context.report.about("objects", is_continued=objects.walk.done > 0):
            placed = objects.advance(depsgraph, shown)
        self.meshes.end_pass()
        return placed

    def instances(
        self, depsgraph: bpy.types.Depsgraph, sources: list[bpy.types.Object], before: list[Instance | None]
    ) -> list[Instance | None]:
        """The instances of mesh objects that nothing multiplies; None for an object that is not rendered.

        before: of those that at most were moved, the instances that they had.
        """
        reader = InstanceReader(self._context, self.materials, self.meshes)
        matrices, usable = usable_matrices(matrices_of(depsgraph, sources))
        with self._context.report.about("objects", is_continued=True):
            descriptions = [
                reader.describe(source, before=known) if good and source.type == "MESH" else None
                for source, good, known in zip(sources, usable.tolist(), before, strict=True)
            ]
        return [
            None if description is None else description.place(matrix)
            for description, matrix in zip(descriptions, matrices, strict=True)
        ]

    def light(self, source: bpy.types.Object, matrix: np.ndarray) -> Light | None:
        """A light object placed by a matrix (4, 4); None when it gives no light."""
        return InstanceReader(self._context, self.materials, self.meshes).light(source, matrix)
