# SPDX-License-Identifier: GPL-3.0-or-later
"""Two levels of deep cubemaps: those of meshes in object space, and those of world triangles and of instances."""

from dataclasses import dataclass

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ..acceleration.instance_records import instance_records
from ..acceleration.instances import BOTTOM_LEVEL_INSTANCE, TOP_LEVEL, InstancedMeshes, TriangleSources
from .arrays import CubemapArrays
from .bottom_levels import MeshBounds, mesh_parameters
from .builder import CubemapBuilder
from .clusters import Clusters
from .records import FIRST_MESH, STATE

_Key = tuple[object, ...]
"""Identity of a cubemap: cubemaps of equal keys hold the same."""
_INSTANCE_GAIN = 4
"""Instances that a cell of the top level has fewer, at least, where it is divided: each costs a ray more than a
triangle does."""


@dataclass(frozen=True)
class _Wanted:
    """A cubemap: the STATE that its build begins with, and objects that must live as long as their ids are a key."""

    parameters: np.void
    owners: tuple[object, ...] = ()


@dataclass(frozen=True)
class _Held:
    """A cubemap that the arrays hold: its STATE, the items of the arrays up to its end, and its owners."""

    state: np.void
    ends: tuple[int, ...]
    owners: tuple[object, ...]


class CubemapLevels(BufferSet):
    """The cubemaps of a scene with instances. What has not changed stays.

    ``arrays``: what the cubemaps hold: those of meshes, that of world triangles, and that of instances.
    """

    remedy = CubemapBuilder.remedy
    _states = StorageBuffer("deep cubemaps of two levels", STATE, texel_bytes=16, block="DeepCubemaps")
    _instances = StorageBuffer(
        "deep cubemap instances",
        BOTTOM_LEVEL_INSTANCE,
        texel_bytes=16,
        remedy="remove instances",
        block="BottomLevelInstances",
    )
    _top_level = StorageBuffer("deep cubemap top level", TOP_LEVEL, 1, block="TopLevelState")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._context, self._library = context, library
        self.arrays = self.own(CubemapArrays(context, library))
        self._held: dict[_Key, _Held] = {}
        """By key, the cubemaps of meshes and world triangles, in the order of the arrays."""
        self._bounds: dict[int, tuple[np.ndarray, MeshBounds]] = {}
        """By the id of a mesh's positions, these, which keeps the id theirs, and the mesh's bounds."""
        self._world: TriangleSources | None = None
        self._world_number = 0
        """Number of times that the world triangles were others than before."""

    @property
    def traversal_blocks(self) -> dict[str, Bindable]:
        """Buffers by block name that rays read."""
        return {**self.arrays.blocks, **self.blocks}

    def clear(self) -> None:
        """Give back what the cubemaps hold."""
        self._bounds, self._world = {}, None
        if self._held:
            self._replace_arrays()
            self._held = {}

    def build(
        self, builder: CubemapBuilder, instanced: InstancedMeshes, parameters: np.void, clusters: Clusters, reach: float
    ) -> np.void:
        """Build what has changed, and the cubemap of instances.

        parameters: the STATE that the build of world triangles begins with; reach: how far from the world's origin
        anything is, meters. Returns the STATE of the cubemap of world triangles. Raises DeviceError.
        """
        records = instance_records(instanced, np.zeros(len(instanced.which), np.int64), reach)
        wanted = self._wanted_meshes(instanced, records, clusters)
        mesh_count = len(wanted)
        if instanced.world != self._world:
            self._world, self._world_number = instanced.world, self._world_number + 1
        wanted["world", self._world_number, clusters.max_size, parameters.tobytes()] = _Wanted(parameters)
        self._arrange(builder, clusters, wanted)
        states = np.array([held.state for held in self._held.values()], STATE.dtype)
        states["first_triangle"] = [each.parameters["first_triangle"] for each in wanted.values()]
        world, top = states[mesh_count], self._build_top(builder, instanced, parameters)
        self._states.upload(np.concatenate([[world, top], states[:mesh_count]]).astype(STATE.dtype))
        self._instances.upload(records)
        level = TOP_LEVEL.zeros(1)
        level["first_hit_triangle"] = instanced.hits.first_triangle
        level["hit_triangle_count"] = instanced.hits.count
        self._top_level.upload(level)
        return world

    def _wanted_meshes(
        self, instanced: InstancedMeshes, records: np.ndarray, clusters: Clusters
    ) -> dict[_Key, _Wanted]:
        """Return the cubemaps of meshes, and fill in which of them each instance, BOTTOM_LEVEL_INSTANCE, has."""
        wanted: dict[_Key, _Wanted] = {}
        places: dict[_Key, int] = {}
        known, self._bounds = self._bounds, {}
        order = np.argsort(instanced.which, kind="stable")
        ends = np.cumsum(np.bincount(instanced.which, minlength=len(instanced.meshes)))
        for number, (mesh, own) in enumerate(zip(instanced.meshes, np.split(order, ends[:-1]), strict=True)):
            arrays = mesh.positions, mesh.corner_vertices, mesh.triangle_corners
            identity = id(mesh.positions)
            _, bounds = self._bounds[identity] = known.get(identity) or (mesh.positions, MeshBounds.of_mesh(mesh))
            exponents = bounds.margin_exponents(records["margin"][own])
            for exponent in np.unique(exponents).tolist():
                key = (*map(id, arrays), exponent, clusters.max_size)
                first = int(instanced.mesh_first_triangles[number])
                wanted.setdefault(key, _Wanted(mesh_parameters(mesh, bounds, exponent, first), arrays))
                records["root"][own[exponents == exponent]] = FIRST_MESH + places.setdefault(key, len(places))
        return wanted

    def _arrange(self, builder: CubemapBuilder, clusters: Clusters, wanted: dict[_Key, _Wanted]) -> None:
        """Hold the wanted cubemaps in their order. Those that are held stay where they are or are copied."""
        held, before, keys = self._held, self.arrays, list(wanted)
        pairs = enumerate(zip(held, keys, strict=False))
        same = next((place for place, (old, new) in pairs if old != new), min(len(held), len(keys)))
        if any(key in held for key in keys[same:]):
            self._replace_arrays(release=False)
            self._held, same = {}, 0
        else:
            self._held = {key: held[key] for key in keys[:same]}
            self.arrays.cut(self._held[keys[same - 1]].ends if same else None)
        try:
            for key in keys[same:]:
                if key in held:
                    state = self.arrays.append(before, held[key].state)
                elif (parameters := wanted[key].parameters)["root_count"]:
                    state = self.arrays.append(builder.buffers, builder.build(parameters, clusters))
                else:
                    state = parameters  # a list
                self._held[key] = _Held(state, self.arrays.ends, wanted[key].owners)
        finally:
            if before is not self.arrays:
                self.disown(before)

    def _build_top(self, builder: CubemapBuilder, instanced: InstancedMeshes, world: np.void) -> np.void:
        """Build the cubemap of instances behind the others, with the parameters of that of world triangles."""
        boxes = np.zeros((max(len(instanced.which), 1), 2, 4), np.float32)
        boxes[: len(instanced.which), :, :3] = instanced.boxes
        builder.buffers.boxes.upload(boxes)
        parameters = world.copy()
        parameters["triangle_count"], parameters["min_gain"] = len(instanced.which), _INSTANCE_GAIN
        return self.arrays.append(builder.buffers, builder.build(parameters, Clusters(are_boxes=True)))

    def _replace_arrays(self, release: bool = True) -> None:
        if release:
            self.disown(self.arrays)
        self.arrays = self.own(CubemapArrays(self._context, self._library))
