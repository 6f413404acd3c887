# SPDX-License-Identifier: GPL-3.0-or-later
"""Indexed arrays to world-space triangles, gathered on the GPU."""

import logging
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.buffers import next_range
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...materials.traits.emitted import Emits, emits
from ...scene.errors import DeviceError, DeviceLostError
from ...scene.light_linking import LightLinking
from ...scene.meshes import Instance, Mesh, MeshShape, RayVisibility
from ...scene.scene import Scene
from ..acceleration.instances import HitNumbers, HitPaths, HitPlaces, InstancedMeshes, TriangleSources
from ..common.active_paths import ActivePaths
from ..common.affine import affine_inverses, determinants
from ..common.records.triangles import TRIANGLE_ATTRIBUTES, TRIANGLE_VERTICES
from ..common.require import require
from ..common.stage_sizes import StageSizes
from .gather_inputs import INSTANCE_ENTRY, GatherInputs, part_starts
from .hit_triangles import HitTriangles
from .object_triangles import ObjectTriangles
from .volume_insets import inset_matrix, volumes_alone

log = logging.getLogger(__name__)

_OBJECTS_NAMED = 3
"""Number of objects that an error names where the device cannot hold all: those of the most triangles."""
_NO_UV = 0xFFFFFFFF
"""In place of where a mesh's UV begin."""
Constants("MeshArrays", NO_UV=_NO_UV)
_ONE_SIDED = 1 << 12
"""In the codes of triangles, above the sets: rays meet it from outside only."""
Constants("TriangleCodes", ONE_SIDED=_ONE_SIDED)

Record("GatherParameters", fallback_point="vec3", first_triangle="uint", triangle_count="uint", instance_count="uint")


_STARTS = {
    "mesh_triangle": "triangle_corners",
    "mesh_corner": "corner_vertices",
    "mesh_vertex": "positions",
    "mesh_uv": "corner_uv",
}
"""Members of InstanceEntry that are where a mesh's part of such an array begins."""
_FAR_VERTICES = 128.0
"""Meters from the origin of their object beyond which vertices are counted from a place among them (_pivots)."""
_MOST_MATERIALS = 1 << 31
"""Numbers of materials where slots are given, all of which are known."""
FARTHEST = 1e15
"""Meters from the origin beyond which no triangle is rendered (shaders/surfaces/geometry/mesh_arrays.glsl)."""
_BLOCK = 256
"""Vertices that are compared side by side: NumPy is slow at reducing many short rows."""


def finite_bounds(positions: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Lowest and highest finite coordinates of points (..., 3), each (3,); None without any."""
    positions = positions.reshape(-1, 3)
    lowest, highest = (_by_column(reduce, positions) for reduce in (np.minimum.reduce, np.maximum.reduce))
    if not np.isfinite([lowest, highest]).all():
        finite = positions[np.isfinite(positions).all(axis=1)]
        if not len(finite):
            return None
        lowest, highest = finite.min(axis=0), finite.max(axis=0)
    return lowest.astype(np.float64), highest.astype(np.float64)


def _by_column(reduce: Callable[..., np.ndarray], positions: np.ndarray) -> np.ndarray:
    """(3,) least or greatest of the columns of (n, 3); not finite without rows."""
    whole = len(positions) // _BLOCK * _BLOCK
    parts = [positions[whole:], np.full((1, 3), np.nan)] if len(positions) == 0 else [positions[whole:]]
    if whole:
        blocks = np.ascontiguousarray(positions[:whole]).reshape(-1, 3 * _BLOCK)
        parts.append(reduce(blocks, axis=0).reshape(-1, 3))
    return reduce(np.concatenate(parts), axis=0)


def placed_boxes(matrices: np.ndarray, boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes around placed boxes.

    matrices: (n, 4, 4); boxes: (n, 2, 3), low and high. Returns low and high, each (n, 3), and whether these are finite
    and not too far away for triangles to be rendered, (n,).
    """
    middle, reach = matrices[:, :3, 3], np.zeros((len(matrices), 3))
    centers, halves = 0.5 * (boxes[:, 0] + boxes[:, 1]), 0.5 * (boxes[:, 1] - boxes[:, 0])
    with np.errstate(invalid="ignore", over="ignore"):
        for axis in range(3):  # written out: thousands of products of small matrices take NumPy long
            column = matrices[:, :3, axis]
            middle = middle + column * centers[:, axis, None]
            reach += np.abs(column) * halves[:, axis, None]
        low, high = middle - reach, middle + reach
    return low, high, (np.maximum(-low, high) < FARTHEST).all(axis=1)  # false for NaN as well


def _pivots(matrices: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """(n, 3) float32 points in object space from which the vertices of placed meshes are counted as they are gathered.

    Maps and scans often have their place in their vertices instead of in their matrices (n, 4, 4): what these add then
    is large, and of the opposite sign. So where the boxes of meshes (n, 2, 3) reach far, vertices are counted from that
    place in the box which lies nearest to the origin; elsewhere from 0.
    """
    nearest = np.clip(affine_inverses(matrices)[:, :, 3], boxes[:, 0], boxes[:, 1])
    reach = np.einsum("nij,nj->ni", np.abs(matrices[:, :3, :3]), np.abs(boxes).max(axis=1)).max(axis=1)
    return np.where(reach[:, None] > _FAR_VERTICES, nearest, 0.0).astype(np.float32)


@dataclass(slots=True)
class Placement:
    """An instance and its first world triangle, which it has where it is expanded to world triangles."""

    instance: Instance
    first_triangle: int


class Geometry(BufferSet):
    """World-space triangles of a scene in GPU buffers.

    ``triangles`` holds three vec4 a triangle (for the fourth components see shaders/surfaces/geometry/gather.comp),
    ``attributes`` a TriangleAttributes each;
    ``placements`` lists the instances that have triangles; ``matrices`` (n, 4, 4) are theirs, and ``boxes`` (n, 2, 3)
    what they lie in, low and high in meters, maybe not finite. ``bounds_low`` and ``bounds_high`` (3,) enclose them.
    """

    remedy = GatherInputs.remedy
    triangles = StorageBuffer("world triangles", TRIANGLE_VERTICES, texel_bytes=16, block="Triangles")
    attributes = StorageBuffer("triangle attributes", TRIANGLE_ATTRIBUTES, texel_bytes=16, block="Attributes")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._context = context
        self._gather = library.compute("surfaces/geometry/gather.comp")
        self._inputs = self.own(GatherInputs(context, library))
        """No part of the set: other programs than those that gather do not read them."""
        self._hits = self.own(HitTriangles(context, library))
        self._objects = self.own(ObjectTriangles(context, library))
        self.instanced: InstancedMeshes | None = None
        """Instances that are not expanded, which rays place in the world; None where there are none."""
        self._bounds: dict[int, tuple[np.ndarray, tuple[np.ndarray, np.ndarray] | None]] = {}
        """By the id of the meshes' positions, these, which keeps the id theirs, and their bounds."""
        self._world: TriangleSources | None = None
        """Sources of the world triangles; None where these are not gathered."""
        self.triangle_count = 0
        self.has_round_shapes = False
        """Whether any triangles stand for strands or points."""
        self.placements: list[Placement] = []
        self.matrices, self.boxes = np.zeros((0, 4, 4)), np.zeros((0, 2, 3))
        self.bounds_low = self.bounds_high = np.zeros(3)

    @property
    def center(self) -> np.ndarray:
        """Center of the bounding sphere, (3,) meters."""
        return 0.5 * (self.bounds_low + self.bounds_high)

    @property
    def expanded(self) -> list[Placement]:
        """Placements of the instances that are expanded to world triangles."""
        placed = set() if self.instanced is None else set(self.instanced.placements.tolist())
        return [placement for number, placement in enumerate(self.placements) if number not in placed]

    @property
    def radius(self) -> float:
        """Radius of the bounding sphere of the bounds, meters; never zero."""
        return max(0.5 * float(np.linalg.norm(self.bounds_high - self.bounds_low)), 1e-9)

    def build(
        self,
        scene: Scene,
        default_material: int,
        swept: tuple[np.ndarray, np.ndarray] | None = None,
        slots: list[Sequence[int]] | None = None,
        is_instanced: np.ndarray | None = None,
    ) -> None:
        """Upload the meshes and gather all instances. ``default_material`` serves empty slots. ``swept``: what the
        bounds enclose in any case, each (3,), low and high. ``slots``: the materials of the slots of each instance, in
        place of its own. ``is_instanced``: (instances,) bool, those that are not expanded to world triangles; None for
        none.

        Arrays that are the very objects of the last build are not uploaded again: moving instances uploads the
        instances only, bending a mesh its positions and normals. Whoever changes an array gives a new one.
        Raises DeviceError when the device cannot hold them.
        """
        used = sorted({instance.mesh for instance in scene.instances})
        meshes = [scene.meshes[index] for index in used]
        bounds = self._bounds_of(meshes)
        places = {
            index: place
            for place, index in enumerate(used)
            if bounds[place] is not None and meshes[place].triangle_count
        }
        chosen = [index for index, instance in enumerate(scene.instances) if instance.mesh in places]
        instances = [scene.instances[index] for index in chosen]
        which = np.array([places[instance.mesh] for instance in instances], np.int64)
        self.matrices = np.array([instance.matrix for instance in instances], np.float64).reshape(-1, 4, 4)
        for number in volumes_alone(instances, scene.materials):
            box = np.array(require(bounds[which[number]]))
            self.matrices[number] = inset_matrix(self.matrices[number], box, number)
        is_expanded = np.ones(len(chosen), bool)
        if is_instanced is not None:  # rays go on in object space, which flat ones do not have
            is_expanded = ~(is_instanced[chosen] & (determinants(self.matrices) != 0.0))
        lengths = np.array([mesh.triangle_count for mesh in meshes], np.int64)[which] * is_expanded
        ends = np.cumsum(lengths)
        self.triangle_count = int(ends[-1]) if len(ends) else 0
        entries = INSTANCE_ENTRY.zeros(len(instances))
        entries["first_triangle"] = ends - lengths
        slot_materials: list[int] = []
        if instances:
            _locate(entries, meshes, which)
            far_boxes = None
            if scene.world_origin is not None:
                far_boxes = np.array([bounds[place] for place in which.tolist()])
            _place(entries, self.matrices, far_boxes)
            is_round = np.array([mesh.shape is not MeshShape.SURFACE for mesh in meshes])[which]
            of_instances = (
                [instance.materials for instance in instances] if slots is None else [slots[index] for index in chosen]
            )
            known = range(len(scene.materials)) if slots is None else range(_MOST_MATERIALS)
            slot_materials = _fill(entries, instances, is_round, of_instances, known, default_material)
        self.has_round_shapes = bool(instances) and bool(is_round.any())
        boxes = np.array([box or np.zeros((2, 3)) for box in bounds]).reshape(-1, 2, 3)
        self.placements = list(map(Placement, instances, entries["first_triangle"].tolist()))
        self._enclose(boxes[which], swept)
        self._inputs.upload_meshes(meshes)
        self._inputs.instances.upload(entries)
        slots_uploaded = np.array(slot_materials or [default_material], np.uint32)
        self._inputs.slot_materials.upload(slots_uploaded)
        expanded = np.flatnonzero(is_expanded)
        placed_meshes = [meshes[index] for index in which[expanded].tolist()]
        # As bytes: copies of records leave the padding between members undefined.
        placed_by = entries.view(np.uint8).reshape(len(entries), INSTANCE_ENTRY.size)[expanded]
        before, self._world = self._world, None  # should gathering fail
        world = TriangleSources(placed_meshes, expanded, placed_by, slots_uploaded)
        first_materials = slots_uploaded[entries["first_slot"]]
        self._place_instanced(scene, meshes, which, np.flatnonzero(~is_expanded), entries, first_materials, world)
        is_new = self._require_triangles(instances, lengths)
        if is_new or world != before:
            self._gather_triangles(len(instances))
        self._objects.gather(self._inputs.blocks, self.triangles, is_new)
        self._world = world

    def _gather_triangles(self, instance_count: int) -> None:
        """Gather the triangles of all that is expanded."""
        inputs = self._inputs.blocks
        for triangles, attributes in zip(
            self.triangles.ranges(self.triangle_count), self.attributes.ranges(self.triangle_count), strict=True
        ):
            self._gather.run(
                triangles.count,
                {**inputs, "Triangles": triangles, "Attributes": attributes},
                {
                    "fallback_point": self.center,
                    "first_triangle": triangles.first,
                    "triangle_count": triangles.count,
                    "instance_count": instance_count,
                },
            )

    def _place_instanced(
        self,
        scene: Scene,
        meshes: list[Mesh],
        which: np.ndarray,
        placements: np.ndarray,
        entries: np.ndarray,
        first_materials: np.ndarray,
        world: TriangleSources,
    ) -> None:
        """Have places behind the world triangles for what instances need that are not expanded. ``which``: the mesh of
        each placement, ``placements``: the numbers of those instances; ``first_materials``: (n,) the material of each
        placement's first slot."""
        self.instanced = None
        first = next_range(self.triangle_count)
        has_emitters = _may_emit(scene, (self.placements[number].instance for number in placements.tolist()))
        self._hits.place(first, StageSizes.of(scene) if len(placements) else None, has_emitters)
        used, one, mesh_of = np.unique(which[placements], return_index=True, return_inverse=True)
        shared = [meshes[index] for index in used]
        self._objects.place(next_range(first + self._hits.count), shared, entries[placements[one]])
        if not len(placements):
            return
        self.instanced = InstancedMeshes(
            shared,
            self._objects.first_triangles,
            mesh_of.reshape(-1),
            placements,
            self.matrices[placements],
            affine_inverses(self.matrices[placements]),
            entries[placements],
            first_materials[placements],
            self.boxes[placements],
            world,
            HitPlaces(self._hits.first, self._hits.count, self._hits.origins.buffer, self._hits.first_hits),
            self._gather_hits,
            has_emitters,
        )

    def _gather_hits(
        self,
        numbers: moderngl.Buffer,
        kind: HitNumbers,
        active: ActivePaths,
        paths: HitPaths,
        blocks: Mapping[str, Bindable],
    ) -> None:
        outputs = self.triangles, self.attributes
        self._hits.gather(numbers, kind, active, paths, {**self._inputs.blocks, **blocks}, outputs, self.center)

    def listed_parts(self, count: int) -> list[slice]:
        """Parts of so many triangles that gather_listed takes at a time."""
        most = self._hits.listed_count
        return [slice(start, min(start + most, count)) for start in range(0, count, most)]

    def gather_listed(self, placement: int, triangles: np.ndarray) -> np.ndarray:
        """Make world triangles of triangles (n,) of the mesh of a placement that is not expanded, while no paths are
        traced; returns their numbers, (n,)."""
        outputs = self.triangles, self.attributes
        return self._hits.gather_listed(placement, triangles, self._inputs.blocks, outputs, self.center)

    def _require_triangles(self, instances: list[Instance], lengths: np.ndarray) -> bool:
        """Have room for the triangles of instances, which have so many each (n,); returns whether the buffers are new.
        Raises DeviceError, which says whose they are."""
        try:
            triangles = attributes = self.triangle_count
            if self.instanced is not None:
                triangles = self._objects.first + self._objects.count
                attributes = self._hits.first + self._hits.count
            is_new = self.triangles.require_items(triangles)
            is_new |= self.attributes.require_items(attributes)
        except DeviceLostError:
            raise
        except DeviceError as error:
            most = objects_of_most(instances, lengths.tolist())
            room = self.triangles.limit // self.triangles.item_size
            held = f"; {room:,} have room in one buffer" if self.triangle_count > room else ""
            raise DeviceError(
                f"{error} (of {self.triangle_count:,} triangles, instances counted each: {most}{held})"
            ) from error
        return is_new

    def _bounds_of(self, meshes: list[Mesh]) -> list[tuple[np.ndarray, np.ndarray] | None]:
        """Finite bounds of each mesh, found once for each array of positions."""
        known, self._bounds = self._bounds, {}
        for positions in (mesh.positions for mesh in meshes):
            if id(positions) not in self._bounds:
                self._bounds[id(positions)] = known.get(id(positions)) or (positions, finite_bounds(positions))
        return [self._bounds[id(mesh.positions)][1] for mesh in meshes]

    def _enclose(self, boxes: np.ndarray, swept: tuple[np.ndarray, np.ndarray] | None) -> None:
        """Find the boxes of the placements, whose meshes lie in boxes (n, 2, 3), and the bounds."""
        low, high = (np.full(3, np.inf), np.full(3, -np.inf)) if swept is None else swept
        lows, highs, good = placed_boxes(self.matrices, boxes)
        self.boxes = np.stack([lows, highs], axis=1)
        low = np.minimum(low, lows[good].min(axis=0, initial=np.inf))
        high = np.maximum(high, highs[good].max(axis=0, initial=-np.inf))
        for index in np.flatnonzero(~good):
            name = self.placements[index].instance.object_name
            log.warning("object %s has a matrix that is not finite; its triangles are left out", name)
        if not np.isfinite(low).all():
            low = high = np.zeros(3)
        self.bounds_low, self.bounds_high = low, high


def _may_emit(scene: Scene, instances: Iterable[Instance]) -> bool:
    """Return True where any of the instances has a material that may emit light."""
    glowing = {m for m, material in enumerate(scene.materials) if emits(material.graph) is not Emits.NOTHING}
    return bool(glowing) and any(not glowing.isdisjoint(instance.materials) for instance in instances)


def objects_of_most(instances: Iterable[Instance], lengths: Iterable[int]) -> str:
    """Names of those whose instances have the most triangles, so many each, and how many all of them have."""
    sums: Counter[str] = Counter()
    for instance, length in zip(instances, lengths, strict=True):
        sums[instance.object_name] += length
    return ", ".join(f'{count:,} of "{name}"' for name, count in sums.most_common(_OBJECTS_NAMED) if count)


def _locate(entries: np.ndarray, meshes: list[Mesh], which: np.ndarray) -> None:
    """Fill in where the arrays of the mesh of each entry begin; which: (n,), the places of these among the meshes."""
    for field, member in _STARTS.items():
        entries[field] = part_starts([_length(getattr(mesh, member)) for mesh in meshes])[:-1][which]
    entries["mesh_uv"][np.array([mesh.corner_uv is None for mesh in meshes])[which]] = _NO_UV


def _place(entries: np.ndarray, matrices: np.ndarray, far_boxes: np.ndarray | None) -> None:
    """Fill in rows and pivots of entries. far_boxes: (n, 2, 3), those of the meshes where the scene is far from the
    world's origin."""
    if far_boxes is not None:
        pivots = _pivots(matrices, far_boxes)
        entries["pivot"] = pivots
        matrices = matrices.copy()
        matrices[:, :3, 3] += np.einsum("nij,nj->ni", matrices[:, :3, :3], pivots)
    for row in range(3):
        entries[f"row{row}"] = matrices[:, row]


def _fill(
    entries: np.ndarray,
    instances: list[Instance],
    is_round: np.ndarray,
    slots_of_instances: Sequence[Sequence[int]],
    known: range,
    default_material: int,
) -> list[int]:
    """Sets, shadows and slots of entries; returns the materials of all slots, the same for instances alike.

    is_round: (n,) bool, of which instances triangles stand for strands or points; slots_of_instances: materials of the
    slots of each; those that are not among the ``known`` are the default material.
    """
    visibility = np.array([int(instance.visibility) for instance in instances])
    shadowless = visibility & int(RayVisibility.SHADOW) == 0
    sets = np.array([_packed_sets(instance.linking) for instance in instances]) + _ONE_SIDED * is_round
    entries["set_code"] = np.where(shadowless, 1 + sets, -sets)  # shaders/common/light_sets.glsl
    slots: list[int] = []
    ranges: dict[tuple[int, ...], tuple[int, int]] = {}
    for key in map(tuple, slots_of_instances):
        if key not in ranges:
            ranges[key] = len(slots), max(1, len(key))
            slots += [m if m in known else default_material for m in key] or [default_material]
    chosen = [ranges[tuple(of_instance)] for of_instance in slots_of_instances]
    entries["first_slot"], entries["slot_count"] = np.array(chosen, np.uint32).T
    return slots


def _packed_sets(linking: LightLinking | None) -> int:
    return 0 if linking is None else linking.receiver_light_set | linking.blocker_shadow_set << 6


def _length(array: np.ndarray | None) -> int:
    return 0 if array is None else len(array)
