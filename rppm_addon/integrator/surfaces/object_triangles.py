# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles in object space of the meshes of instances that are not expanded."""

from collections.abc import Mapping

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.buffers import GrowingBuffer
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...scene.meshes import Mesh
from ..acceleration.instances import TriangleSources
from .gather_inputs import INSTANCE_ENTRY


class ObjectTriangles(BufferSet):
    """Places in the block Triangles for the triangles of meshes in object space, which rays place in the world."""

    _entries = StorageBuffer("meshes in object space", INSTANCE_ENTRY, texel_bytes=16, remedy="remove meshes")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._gather = library.compute("surfaces/geometry/gather_object.comp")
        self.first = self.count = 0
        """First triangle of the meshes, and their number."""
        self.first_triangles = np.zeros(0, np.int64)
        """(meshes,) the first triangle of each mesh."""
        self._wanted: TriangleSources | None = None
        """Sources of the triangles that there are places for."""
        self._gathered: TriangleSources | None = None
        """Sources of the triangles that are there."""

    def place(self, first: int, meshes: list[Mesh], starts: np.ndarray) -> None:
        """Have places for the triangles of meshes from a triangle on. ``starts``: (meshes,) INSTANCE_ENTRY records that
        say where the arrays of each mesh begin."""
        lengths = np.array([mesh.triangle_count for mesh in meshes], np.int64)
        ends = np.cumsum(lengths)
        self.first, self.count = first, int(ends[-1]) if len(ends) else 0
        self.first_triangles = first + ends - lengths
        entries = starts.copy()
        entries["first_triangle"] = ends - lengths
        self._wanted = TriangleSources(meshes, np.array([first]))
        if len(entries):
            self._entries.upload(entries)

    def gather(self, inputs: Mapping[str, Bindable], triangles: GrowingBuffer, is_new: bool) -> None:
        """Write the triangles, by the inputs of gathering, unless those of the same meshes are at the same places.
        ``is_new``: whether the buffer of triangles is another one than before."""
        before, self._gathered = self._gathered, None  # should gathering fail
        if is_new or self._wanted != before:
            self._write(inputs, triangles)
        self._gathered = self._wanted

    def _write(self, inputs: Mapping[str, Bindable], triangles: GrowingBuffer) -> None:
        for part in triangles.ranges(self.count, self.first):
            self._gather.run(
                part.count,
                {**inputs, "Instances": self._entries.buffer, "Triangles": part},
                {
                    "fallback_point": np.zeros(3),
                    "first_triangle": part.first - self.first,
                    "triangle_count": part.count,
                    "instance_count": len(self.first_triangles),
                },
            )
