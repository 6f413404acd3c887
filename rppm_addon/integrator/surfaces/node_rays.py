# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays that nodes of materials ask for: what Ambient Occlusion and Bevel find around the places that are resolved, and
Raycast from anywhere.

Programs of materials only ask, and one program traces for all of them: with the traversal inside, each would take as
long to compile, and more storage blocks than devices have. A hit on such a material is evaluated once more for each
level of nodes: those of the first level ask, what they ask is traced, those that depend on it ask, and so on.
"""

import enum
from collections.abc import Mapping

import moderngl

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable, ComputeProgram
from ...gl.programs.programs import ProgramLibrary
from ...materials.compiler.compiled_graph import MAX_NODE_RAYS, NodeRayCounts
from ..acceleration.acceleration_structure import AccelerationStructure

Record(
    "NodeRaysParameters",
    seed="uint",
    iteration="uint",
    segment="uint",
    program="uint",
    ray_stride="uint",
    ray_places="uint",
    ray_level="uint",
    first_sample="uint",
    sample_count="uint",
    samples="uint",
)
NODE_RAY = Record("NodeRay", direction="vec3", query="uint", found="vec3", reach="float")
"""A node's query: the unit vector around which rays go and how far they reach, meters; and what they found so far:
how many met nothing, or the weighted sum of normals. ``query`` is 0 where nothing is asked. A Raycast's record finds a
normal, and a second record follows it. First the ``direction`` of the second is where the ray begins; then it holds two
barycentric coordinates of the hit and the lower 24 bits of the mesh's triangle. ``reach`` holds the other 8, and above
them the lower 16 bits of the instance; ``found`` the distance, meters, 0 where nothing was met, else 1 plus the other
bits of the instance, and whether the object itself was met. So all are whole numbers that floats have exactly."""
StorageBlock("NodeRays", "NodeRay node_rays[];")


class NodeRayQuery(enum.IntEnum):
    """Kinds of queries, by what their rays look for."""

    OCCLUSION = 1
    LOCAL_OCCLUSION = 2
    """By the object itself."""
    BEVEL = 3
    RAYCAST = 4
    """The nearest along a ray from anywhere."""
    LOCAL_RAYCAST = 5


Constants(
    "NodeRayQueries",
    QUERY=NodeRayQuery,
    QUERY_KIND=0x7,
    QUERY_FROM_SURFACE=0x8,
    QUERY_LEVEL=0xFFF,
    QUERY_LEVEL_SHIFT=4,
    QUERY_SAMPLES_SHIFT=16,
    MAX_NODE_RAYS=MAX_NODE_RAYS,
)
_SAMPLES_AT_ONCE = 8
"""llvmpipe ends all loops of a thread after 65535 rounds in all."""


class NodeRays(BufferSet):
    """Questions and answers of the paths whose hits are resolved, ``places`` of them a path."""

    remedy = "lower the resolution or the photons per iteration, or bake what Ambient Occlusion and Bevel nodes give"
    _rays = StorageBuffer("rays of nodes", NODE_RAY)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._library = library

    def require(self, count: int) -> moderngl.Buffer:
        """Room for so many NODE_RAY, by path and place. Raises DeviceError."""
        if self._rays.require_items(count):
            self._rays.clear()
        return self._rays.buffer

    def program(self, traversal: AccelerationStructure, casts: bool) -> ComputeProgram:
        """Return the program that traces the rays of nodes; where there are cores to spare it is compiled between
        asking for it and its first run. casts: also rays that begin anywhere, of which the program without knows
        nothing."""
        defines = {**traversal.traversal_defines, **({"RAYCASTS": 1} if casts else {})}
        if traversal.has_instances:
            defines["NODE_HITS"] = "surfaces/node_rays/two_levels"
        return self._library.compute("surfaces/node_rays/trace.comp", defines)

    def trace(
        self,
        program: ComputeProgram,
        order: moderngl.Buffer,
        arguments: int,
        buffers: Mapping[str, Bindable],
        counts: NodeRayCounts,
        parameters: Mapping[str, object],
    ) -> None:
        """Answer what the nodes of a program ask at a level.

        program: ``program``'s; order: HitOrder; arguments: its byte where the groups of the dispatch are; buffers:
        NodeRays, Rays, Hits, Attributes, those of the traversal and the arrays of meshes among others; counts: of the
        program that asks;
        parameters: the others of NodeRaysParameters.
        """
        of_all = {**parameters, "ray_places": counts.places, "samples": counts.samples}
        for first in range(0, counts.samples, _SAMPLES_AT_ONCE):
            program.run_indirect(
                order,
                arguments,
                {**buffers, "HitOrder": order},
                {**of_all, "first_sample": first, "sample_count": _SAMPLES_AT_ONCE},
            )
