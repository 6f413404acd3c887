# SPDX-License-Identifier: GPL-3.0-or-later
"""Bvh: a bounding volume hierarchy, built by the processor, traced through by the device.

A software driver traces rays through it in two thirds to a fifth of the time that a deep cubemap takes
(docs/benchmarks/moves.md): a step tests two boxes, which takes few operations.
"""

from collections.abc import Iterable

import moderngl
import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..acceleration.acceleration_structure import MARGIN, AccelerationStructure
from ..acceleration.instance_records import instance_records
from ..acceleration.instances import BOTTOM_LEVEL_INSTANCE, TOP_LEVEL, InstancedMeshes, TriangleSources
from .bottom_levels import BottomLevels, moved_nodes, top_level_nodes
from .clustering import MAX_DEPTH, NODE
from .leaves import LEAF, triangle_nodes

Constants("BvhNodes", LEAF=LEAF, MAX_DEPTH=MAX_DEPTH)
StorageBlock("BvhNodes", "BvhNode bvh_nodes[];")

_TRIANGLE_BYTES = 48


class Bvh(AccelerationStructure):
    """A binary hierarchy of boxes on the device. Its leaves hold one triangle, or two that follow each other."""

    shader = "bvh/traverse.glsl"
    remedy = "simplify the geometry"
    _nodes = StorageBuffer("BVH nodes", NODE, texel_bytes=16, block="BvhNodes")
    _instances = StorageBuffer(
        "BVH instances", BOTTOM_LEVEL_INSTANCE, texel_bytes=16, remedy="remove instances", block="BottomLevelInstances"
    )
    _top_level = StorageBuffer("BVH top level", TOP_LEVEL, 1, block="TopLevelState")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._bottom_levels = BottomLevels()
        self._world_nodes = NODE.zeros(0)
        """Hierarchy of the world triangles beside instances."""
        self._world: TriangleSources | None = None
        """World triangles that this was built for."""
        self._world_margin = 0.0

    def build(
        self,
        triangles: moderngl.Buffer,
        triangle_count: int,
        center: Iterable[float],
        scene_radius: float,
        resolution: int = 0,
        has_one_sided: bool = False,
        instanced: InstancedMeshes | None = None,
    ) -> None:
        """AccelerationStructure.build. Hierarchies of meshes that have not changed stay."""
        self._has_one_sided, self._instanced = has_one_sided, instanced
        margin = max(float(scene_radius), 1e-20) * MARGIN
        if instanced is None:
            self._bottom_levels, self._world_nodes, self._world = BottomLevels(), NODE.zeros(0), None
            nodes = triangle_nodes(_read_vertices(triangles, triangle_count), margin)
            self._nodes.require_items(len(nodes))
            self._nodes.write(nodes)
            self._traversal_buffers = {"Triangles": triangles, "BvhNodes": self._nodes.buffer}
            return
        is_new = self._bottom_levels.build(instanced.meshes)
        # A hierarchy whose margin is half of the wanted one still leaves fifteen times the rounding error.
        if instanced.world != self._world or margin > 2.0 * self._world_margin:
            self._world_nodes = triangle_nodes(_read_vertices(triangles, triangle_count), margin)
            self._world, self._world_margin, is_new = instanced.world, margin, True
        reach = float(scene_radius) + float(np.linalg.norm(np.fromiter(center, np.float64)))
        self._write_levels(instanced, margin, reach, is_new)
        self._traversal_buffers = {"Triangles": triangles, "HitOrigins": instanced.hits.origins, **self.blocks}

    def _write_levels(self, instanced: InstancedMeshes, margin: float, reach: float, is_new: bool) -> None:
        """Write the top level, and where those are new the hierarchies of the meshes and of the world triangles."""
        levels = self._bottom_levels
        first_world = levels.node_count
        first_top = first_world + len(self._world_nodes)
        top = top_level_nodes(self._world_nodes, first_world, margin, instanced)
        if self._nodes.require_items(first_top + len(top)) or is_new:
            self._nodes.write(levels.nodes())
            self._nodes.write(moved_nodes(self._world_nodes, first_world), first_world * NODE.size)
        self._nodes.write(top, first_top * NODE.size)
        self._instances.upload(instance_records(instanced, levels.roots[instanced.which], reach))
        state = TOP_LEVEL.zeros(1)
        state["root"], state["first_hit_triangle"] = first_top, instanced.hits.first_triangle
        state["hit_triangle_count"] = instanced.hits.count
        self._top_level.upload(state)

    @property
    def traversal_defines(self) -> dict[str, object]:
        """AccelerationStructure.traversal_defines."""
        if self._instanced is None:
            return super().traversal_defines
        return {**super().traversal_defines, "TRAVERSAL": "bvh/traverse_two_levels.glsl"}


def _read_vertices(triangles: moderngl.Buffer, count: int) -> np.ndarray:
    """(count, 3, 3) float32 vertices of triangles, meters."""
    read = triangles.read(_TRIANGLE_BYTES * count) if count else b""
    return np.frombuffer(read, np.float32).reshape(-1, 3, 4)[..., :3]
