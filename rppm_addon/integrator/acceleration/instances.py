# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances whose triangles rays place in the world: the top level of two-level acceleration structures."""

import enum
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import moderngl
import numpy as np

from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.programs.program import Bindable
from ...scene.meshes import Mesh
from ...scene.storage.sharing import same_members
from ..common.active_paths import ActivePaths

TOP_LEVEL = Record("TopLevel", root="uint", first_hit_triangle="uint", hit_triangle_count="uint")
"""The root of the top level; the hit triangles: the first and their number, two for each path."""
StorageBlock("TopLevelState", "TopLevel top_level;")
BOTTOM_LEVEL_INSTANCE = Record(
    "BottomLevelInstance",
    to_object0="vec4",
    to_object1="vec4",
    to_object2="vec4",
    row0="vec4",
    row1="vec4",
    row2="vec4",
    pivot="vec3",
    first_triangle="uint",
    root="uint",
    placement="uint",
    mirrored="uint",
    margin="float",
    set_code="float",
    first_slot="uint",
    slot_count="uint",
)
"""An instance of a mesh that has an acceleration structure of its own.

``to_object``: the rows of its world-to-object matrix. ``row``, ``pivot``: vertices, less the pivot, are placed in the
world by these rows. ``first_triangle``: of its mesh in object space, in the block Triangles; ``root``: of its mesh's
structure. ``placement``: its number among all instances. ``margin``: by which boxes of the mesh are widened, in object
space. ``set_code``: as of triangles (shaders/common/light_sets.glsl). ``first_slot``, ``slot_count``: of its materials,
in the block SlotMaterials.
"""
StorageBlock("BottomLevelInstances", "BottomLevelInstance bottom_level_instances[];")
StorageBlock("HitOrigins", "uvec2 hit_origins[];")
"""For each hit triangle the instance, of BottomLevelInstances, and the triangle of its mesh."""
Record("TraceParameters", first_hit="uint")
INSTANCE_LEAF = 3
"""In place of the number of triangles of a leaf: it holds an instance."""
Constants("InstanceLeaf", INSTANCE_LEAF=INSTANCE_LEAF)


class HitPaths(enum.Enum):
    """Lists of paths whose hits other kernels read, and which have hit triangles of their own."""

    CAMERA = "camera"
    PHOTON = "photon"
    SHADOW = "shadow"
    SUBSURFACE = "subsurface"
    LIGHT = "light"
    """Emissive triangles of instances that shadow rays go to."""


class HitNumbers(enum.Enum):
    """Buffers that hold the numbers of hit triangles to be gathered: the block, and the folder of the shader that reads
    it."""

    HITS = "Hits", "surfaces/geometry/hits"
    LIGHTS = "LightTriangles", "surfaces/geometry/lights"
    """Triangles that shadow rays go to."""
    SOURCES = "Rays", "surfaces/geometry/sources"
    """Triangles that rays come from."""

    @property
    def block(self) -> str:
        """Name of the storage block."""
        return self.value[0]

    @property
    def shader(self) -> str:
        """Folder below that of shaders from which gather_hits.comp takes hit_number.glsl."""
        return self.value[1]


@dataclass(frozen=True)
class HitPlaces:
    """Places for the triangles that paths hit, behind those of the world triangles."""

    first_triangle: int
    """Number of the first hit triangle."""
    count: int
    origins: moderngl.Buffer
    """The block HitOrigins."""
    of_paths: dict[HitPaths, int]
    """The first hit triangle of each list of paths, counted from first_triangle."""


class TriangleSources:
    """Meshes and places that triangles on the device are made of: equal to others of which the same ones are made."""

    def __init__(self, meshes: list[Mesh], *places: np.ndarray) -> None:
        """meshes: those that have triangles there, each once; places: arrays by which instances are placed, and which
        tell the mesh of each."""
        self._arrays = [array for mesh in meshes for array in _arrays_of(mesh)]
        self._places = [array.tobytes() for array in places]

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, TriangleSources)
            and same_members(self._arrays, other._arrays)
            and self._places == other._places
        )

    __hash__ = None  # type: ignore[assignment]  # compared only


def _arrays_of(mesh: Mesh) -> tuple[np.ndarray | None, ...]:
    return (
        mesh.positions, mesh.corner_vertices, mesh.triangle_corners, mesh.corner_normals, mesh.corner_uv,
        mesh.triangle_slots,
    )  # fmt: skip


@dataclass(frozen=True)
class InstancedMeshes:
    """Instances of a scene that are not expanded to world triangles, and their meshes."""

    meshes: list[Mesh]
    mesh_first_triangles: np.ndarray
    """(meshes,) int64, the first triangle of each mesh in the block Triangles, in object space."""
    which: np.ndarray
    """(n,) int64, the mesh of each instance, by its place in ``meshes``."""
    placements: np.ndarray
    """(n,) int64, the number of each among all instances."""
    are_mirrored: np.ndarray
    """(n,) bool, those whose matrix mirrors."""
    matrices: np.ndarray
    """(n, 4, 4) float64, object to world."""
    entries: np.ndarray
    """(n,) records with row0, row1, row2, pivot, set_code, first_slot and slot_count, as the triangles of expanded
    instances are placed by."""
    first_materials: np.ndarray
    """(n,) uint32, the material of the first slot of each."""
    boxes: np.ndarray
    """(n, 2, 3) float64, low and high corners in the world, meters."""
    versions: np.ndarray
    """(n,) int64, the ``version`` since which each is as it is."""
    version: int
    """Number of the build that these are of, among those of their geometry."""
    world: TriangleSources
    hits: HitPlaces
    """Places of the triangles that paths hit."""
    gather_hits: Callable[[moderngl.Buffer, HitNumbers, ActivePaths, HitPaths, Mapping[str, Bindable]], None]
    """Makes world triangles of those that a buffer names for active paths of a list, by the acceleration structure's
    blocks."""
    emitters: np.ndarray
    """(k,) int64, the rows of instances that may emit light, ascending."""

    @property
    def has_emitters(self) -> bool:
        """True where any of the instances may emit light."""
        return len(self.emitters) > 0

    def has_rows_of(self, before: "InstancedMeshes") -> bool:
        """True where the rows are those of the same instances, with the same meshes and slots at the same places."""
        return (
            np.array_equal(self.placements, before.placements)
            and np.array_equal(self.which, before.which)
            and np.array_equal(self.mesh_first_triangles, before.mesh_first_triangles)
            and all(np.array_equal(self.entries[name], before.entries[name]) for name in ("first_slot", "slot_count"))
        )

    def changed_since(self, before: "InstancedMeshes") -> np.ndarray:
        """(k,) the rows that are not as they were, ascending. ``before``: an earlier build of the same geometry."""
        return np.flatnonzero(self.versions > before.version)

    @property
    def triangle_count(self) -> int:
        """Triangles of all meshes."""
        return sum(mesh.triangle_count for mesh in self.meshes)

    @property
    def placed_triangle_count(self) -> int:
        """Triangles of all instances."""
        lengths = np.array([mesh.triangle_count for mesh in self.meshes], np.int64)
        return int(lengths[self.which].sum())
