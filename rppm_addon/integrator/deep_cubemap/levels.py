# SPDX-License-Identifier: GPL-3.0-or-later
"""Two levels of deep cubemaps: those of meshes in object space, and those of world triangles and of instances."""

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...scene.meshes import Mesh
from ..acceleration.instance_records import instance_records
from ..acceleration.instances import BOTTOM_LEVEL_INSTANCE, TOP_LEVEL, InstancedMeshes
from .arrays import CubemapArrays
from .bottom_levels import MAX_LISTED, MeshBounds, listed_mesh, mesh_parameters
from .builder import CubemapBuilder
from .clusters import Clusters
from .records import FIRST_MESH, STATE

_Key = tuple[int, int, int, int, int]
"""The ids of a mesh's arrays, the exponent of its margin, and the size of the largest clusters."""
_INSTANCE_GAIN = 4
"""Instances that a cell of the top level has fewer, at least, where it is divided: each costs a ray more than a
triangle does."""


class CubemapLevels(BufferSet):
    """The cubemaps of a scene with instances. Those of meshes stay as long as the meshes' arrays do.

    ``arrays``: what the cubemaps hold, those of meshes first.
    """

    remedy = CubemapBuilder.remedy
    _states = StorageBuffer("deep cubemaps of two levels", STATE, texel_bytes=16, block="DeepCubemaps")
    _instances = StorageBuffer(
        "deep cubemap instances", BOTTOM_LEVEL_INSTANCE, texel_bytes=16, remedy="remove instances",
        block="BottomLevelInstances",
    )  # fmt: skip
    _top_level = StorageBuffer("deep cubemap top level", TOP_LEVEL, 1, block="TopLevelState")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._context, self._library = context, library
        self.arrays = self.own(CubemapArrays(context, library))
        self._meshes: dict[_Key, tuple[Mesh, np.void]] = {}
        """The meshes in their order, whose arrays keep the ids theirs, and the STATE of the cubemap of each."""
        self._records = BOTTOM_LEVEL_INSTANCE.zeros(0)

    @property
    def traversal_blocks(self) -> dict[str, Bindable]:
        """Buffers by block name that rays read."""
        return {**self.arrays.blocks, **self.blocks}

    def clear(self) -> None:
        """Give back what the cubemaps hold."""
        if self._meshes:
            self.disown(self.arrays)
            self._meshes, self.arrays = {}, self.own(CubemapArrays(self._context, self._library))

    def build_meshes(
        self, builder: CubemapBuilder, instanced: InstancedMeshes, clusters: Clusters, reach: float
    ) -> None:
        """Have the cubemaps of all meshes. reach: how far from the world's origin anything is, meters.

        Raises DeviceError.
        """
        records = instance_records(instanced, np.zeros(len(instanced.which), np.int64), reach)
        wanted: dict[_Key, tuple[int, MeshBounds, int]] = {}
        places: dict[_Key, int] = {}
        order = np.argsort(instanced.which, kind="stable")
        ends = np.cumsum(np.bincount(instanced.which, minlength=len(instanced.meshes)))
        for number, (mesh, own) in enumerate(zip(instanced.meshes, np.split(order, ends[:-1]), strict=True)):
            bounds = MeshBounds.of_mesh(mesh)
            exponents = bounds.margin_exponents(records["margin"][own])
            for exponent in np.unique(exponents).tolist():
                arrays = mesh.positions, mesh.corner_vertices, mesh.triangle_corners
                key = (*(id(array) for array in arrays), exponent, clusters.max_size)
                wanted.setdefault(key, (number, bounds, exponent))
                records["root"][own[exponents == exponent]] = FIRST_MESH + places.setdefault(key, len(places))
        self._records = records
        if list(wanted) != list(self._meshes):
            self._arrange(builder, instanced, clusters, wanted)
        for key, (number, _, _) in wanted.items():
            self._meshes[key][1]["first_triangle"] = instanced.mesh_first_triangles[number]

    def _arrange(
        self,
        builder: CubemapBuilder,
        instanced: InstancedMeshes,
        clusters: Clusters,
        wanted: dict[_Key, tuple[int, MeshBounds, int]],
    ) -> None:
        """Put the cubemaps of the wanted meshes behind one another; those that are known are copied."""
        known, before = self._meshes, self.arrays
        self._meshes, self.arrays = {}, self.own(CubemapArrays(self._context, self._library))
        for key, (number, bounds, exponent) in wanted.items():
            mesh = instanced.meshes[number]
            if key in known:
                state = self.arrays.append(before, known[key][1])
            else:
                first = int(instanced.mesh_first_triangles[number])
                parameters = mesh_parameters(mesh, bounds, exponent, first)
                if mesh.triangle_count <= MAX_LISTED:
                    state = listed_mesh(parameters, bounds)
                else:
                    state = self.arrays.append(builder.buffers, builder.build(parameters, clusters))
            self._meshes[key] = mesh, state
        self.arrays.keep()
        self.disown(before)

    def build_top(
        self, builder: CubemapBuilder, instanced: InstancedMeshes, world: np.void, parameters: np.void
    ) -> None:
        """Take the cubemap of world triangles that the builder has just made, with its STATE and the STATE that its
        build began with, and build that of instances. Raises DeviceError."""
        self.arrays.drop()
        states = [self.arrays.append(builder.buffers, world)]
        boxes = np.zeros((max(len(instanced.which), 1), 2, 4), np.float32)
        boxes[: len(instanced.which), :, :3] = instanced.boxes
        builder.buffers.boxes.upload(boxes)
        parameters = parameters.copy()
        parameters["triangle_count"], parameters["min_gain"] = len(instanced.which), _INSTANCE_GAIN
        top = builder.build(parameters, Clusters(are_boxes=True))
        states.append(self.arrays.append(builder.buffers, top))
        self._states.upload(np.array([*states, *(state for _, state in self._meshes.values())], STATE.dtype))
        self._instances.upload(self._records)
        level = TOP_LEVEL.zeros(1)
        level["first_hit_triangle"] = instanced.first_hit_triangle
        level["hit_triangle_count"] = instanced.hit_triangle_count
        self._top_level.upload(level)
