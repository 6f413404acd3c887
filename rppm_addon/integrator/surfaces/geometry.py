# SPDX-License-Identifier: GPL-3.0-or-later
"""Indexed arrays to world-space triangles, gathered on the GPU."""

import logging
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.buffers import next_range
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...materials.traits.emitted import glowing_materials
from ...scene.errors import DeviceError, DeviceLostError
from ...scene.meshes import Instance, Mesh, MeshShape, RayVisibility
from ...scene.scene import Scene
from ..acceleration.instances import HitNumbers, HitPaths, HitPlaces, InstancedMeshes, TriangleSources
from ..common.active_paths import ActivePaths
from ..common.instance_columns import InstanceColumns, numbered
from ..common.records.triangles import TRIANGLE_ATTRIBUTES, TRIANGLE_VERTICES
from ..common.require import require
from ..common.stage_sizes import StageSizes
from .gather_inputs import INSTANCE_ENTRY, GatherInputs, locate, place_slots
from .hit_triangles import HitTriangles, traced_lists
from .object_triangles import ObjectTriangles
from .placements import PlacedArrays, PlacedMeshes, Placement, Placements
from .volume_insets import inset_matrix, volumes_alone

log = logging.getLogger(__name__)

_OBJECTS_NAMED = 3
"""Number of objects that an error names where the device cannot hold all: those of the most triangles."""
_ONE_SIDED = 1 << 12
"""In the codes of triangles, above the sets: rays meet it from outside only."""
Constants("TriangleCodes", ONE_SIDED=_ONE_SIDED)

Record("GatherParameters", fallback_point="vec3", first_triangle="uint", triangle_count="uint", instance_count="uint")


_MOST_MATERIALS = 1 << 31
"""Numbers of materials where slots are given, all of which are known."""
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


class Geometry(BufferSet):
    """World-space triangles of a scene in GPU buffers.

    ``triangles`` holds three vec4 a triangle (for the fourth components see shaders/surfaces/geometry/gather.comp),
    ``attributes`` a TriangleAttributes each;
    ``placements`` lists the instances that have triangles, ``placed`` what follows from their places.
    ``bounds_low`` and ``bounds_high`` (3,) enclose them.
    """

    remedy = GatherInputs.remedy
    triangles = StorageBuffer("world triangles", TRIANGLE_VERTICES, texel_bytes=16, block="Triangles")
    attributes = StorageBuffer("triangle attributes", TRIANGLE_ATTRIBUTES, texel_bytes=16, block="Attributes")

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
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
        self.columns = InstanceColumns()
        """Columns of all instances of the scene, those without triangles included."""
        self.placements = Placements([], np.zeros(0, np.int64))
        self.placed = PlacedArrays()
        """Arrays of the placements."""
        self._placed_of: PlacedMeshes | None = None
        """Meshes and instances that the arrays of the placements are of; None where these are not known."""
        self.bounds_low = self.bounds_high = np.zeros(3)

    @property
    def matrices(self) -> np.ndarray:
        """(n, 4, 4) float64 of the placements."""
        return self.placed.matrices

    @property
    def boxes(self) -> np.ndarray:
        """(n, 2, 3) float64 around the placements, meters."""
        return self.placed.boxes

    @property
    def center(self) -> np.ndarray:
        """Center of the bounding sphere, (3,) meters."""
        return 0.5 * (self.bounds_low + self.bounds_high)

    @property
    def placed_meshes(self) -> PlacedMeshes:
        """Meshes and instances of the placements, once they were built."""
        return require(self._placed_of)

    @property
    def mesh_blocks(self) -> Mapping[str, Bindable]:
        """Storage blocks of the arrays of all meshes and of the instances, which triangles are gathered from."""
        return self._inputs.blocks

    @property
    def expanded(self) -> Sequence[Placement]:
        """Placements of the instances that are expanded to world triangles."""
        if self.instanced is None:
            return self.placements
        numbers = np.delete(np.arange(len(self.placements)), self.instanced.placements)
        return [self.placements[number] for number in numbers.tolist()]

    @property
    def radius(self) -> float:
        """Radius of the bounding sphere of the bounds, meters; never zero."""
        return max(0.5 * float(np.linalg.norm(self.bounds_high - self.bounds_low)), 1e-9)

    def forget(self) -> None:
        """Have the next build read all instances."""
        self.columns = InstanceColumns()

    def build(
        self,
        scene: Scene,
        default_material: int,
        swept: tuple[np.ndarray, np.ndarray] | None = None,
        slots: list[Sequence[int]] | None = None,
        instanced: Callable[[InstanceColumns], np.ndarray | None] | None = None,
        passes_surfaces: bool = True,
    ) -> None:
        """Upload the meshes and gather all instances. ``default_material`` serves empty slots. ``swept``: what the
        bounds enclose in any case, each (3,), low and high. ``slots``: the materials of the slots of each instance, in
        place of its own. ``instanced``: gives by the columns of all instances those, (instances,) bool, that are not
        expanded to world triangles, or None for none. ``passes_surfaces``: whether shadow rays may pass surfaces.

        Arrays that are the very objects of the last build are not uploaded again: moving instances uploads the
        instances only, bending a mesh its positions and normals. Instances that are the very objects of the last build
        are not read again. Whoever changes an array or an instance gives a new one.
        Raises DeviceError when the device cannot hold them.
        """
        of = self._place(scene)
        meshes, chosen, which = of.meshes, of.chosen, of.which
        is_expanded = np.ones(len(chosen), bool)
        if instanced is not None:
            is_expanded[self._placed_by_rays(instanced)] = False
        lengths = np.array([mesh.triangle_count for mesh in meshes], np.int64)[which] * is_expanded
        ends = np.cumsum(lengths)
        self.triangle_count = int(ends[-1]) if len(ends) else 0
        entries, slots_uploaded = self._entries(of, scene, slots, default_material)
        entries["first_triangle"] = ends - lengths
        self.placements = Placements(of.instances, entries["first_triangle"])
        self._enclose(swept)
        self._inputs.upload_meshes(meshes)
        self._inputs.instances.upload(entries)
        self._inputs.slot_materials.upload(slots_uploaded)
        expanded = np.flatnonzero(is_expanded)
        placed_meshes = [meshes[index] for index in np.flatnonzero(np.bincount(which[expanded])).tolist()]
        # As bytes: copies of records leave the padding between members undefined.
        placed_by = entries.view(np.uint8).reshape(len(entries), INSTANCE_ENTRY.size)[expanded]
        before, self._world = self._world, None  # should gathering fail
        world = TriangleSources(placed_meshes, expanded, placed_by, slots_uploaded)
        first_materials = slots_uploaded[entries["first_slot"]]
        by_rays = np.flatnonzero(~is_expanded)
        self._place_instanced(scene, meshes, which, by_rays, entries, first_materials, world, passes_surfaces)
        # After a build that failed, a buffer may be another one without what it held.
        is_new = self._require_triangles(of.instances, lengths) or before is None
        if is_new or world != before:
            self._gather_triangles(len(of.instances))
        self._objects.gather(self._inputs.blocks, self.triangles, is_new)
        self._world = world

    def would_place(
        self, scene: Scene, instanced: Callable[[InstanceColumns], np.ndarray | None], passes_surfaces: bool = True
    ) -> bool:
        """Return True where a build of a scene with the instances of the last one, whose materials, settings or size
        may be others, would expand the same ones, the same of the others might emit light, and all paths have places
        for what they hit. ``instanced``, ``passes_surfaces``: as build takes them."""
        placements = self._placed_by_rays(instanced)
        if self.instanced is None:
            return not len(placements)
        emitters = self._emitters_among(placements, scene)
        sizes = StageSizes.of(scene)
        return (
            np.array_equal(placements, self.instanced.placements)
            and np.array_equal(emitters, self.instanced.emitters)
            and self._hits.has_room(sizes, traced_lists(sizes, passes_surfaces, len(emitters) > 0))
        )

    def _placed_by_rays(self, instanced: Callable[[InstanceColumns], np.ndarray | None]) -> np.ndarray:
        """(k,) int64, ascending, the placements that are not expanded: rays go on in object space, which flat ones do
        not have."""
        wanted = instanced(self.columns)
        if wanted is None:
            return np.zeros(0, np.int64)
        return np.flatnonzero(wanted[self.placed_meshes.chosen] & (self.placed.determinants != 0.0))

    def _place(self, scene: Scene) -> PlacedMeshes:
        """Take the instances of a scene that have triangles, and place them; returns what these are."""
        before, self._placed_of = self._placed_of, None  # should anything fail
        columns = self.columns
        read = columns.follow(scene.instances)
        used = np.flatnonzero(np.bincount(columns.meshes)).tolist()
        meshes = [scene.meshes[index] for index in used]
        bounds = self._bounds_of(meshes)
        places = np.full(len(scene.meshes), -1)
        for place, (index, mesh) in enumerate(zip(used, meshes, strict=True)):
            if bounds[place] is not None and mesh.triangle_count:
                places[index] = place
        chosen = np.flatnonzero(places[columns.meshes] >= 0)
        has_all = len(chosen) == len(scene.instances)
        instances = list(scene.instances) if has_all else [scene.instances[index] for index in chosen.tolist()]
        which = places[columns.meshes[chosen]]
        boxes = np.array([box or np.zeros((2, 3)) for box in bounds]).reshape(-1, 2, 3)
        insets = volumes_alone(columns.material_lists, scene.materials)
        are_inset = np.flatnonzero(np.isin(columns.materials[chosen], insets)) if insets else np.zeros(0, np.int64)
        matrices = columns.matrices if has_all and not len(are_inset) else columns.matrices[chosen]
        for number in are_inset.tolist():
            matrices[number] = inset_matrix(matrices[number], boxes[which[number]], number)
        has_pivots = scene.world_origin is not None
        of = PlacedMeshes(instances, chosen, meshes, bounds, which, has_pivots, are_inset)
        self.placed.take(matrices, boxes, which, has_pivots, of.changed_since(before, read))
        self._placed_of = of
        return of

    def _entries(
        self, of: PlacedMeshes, scene: Scene, slots: list[Sequence[int]] | None, default_material: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """INSTANCE_ENTRY records of the placements, whose first triangles are left out, and the materials of all slots,
        uint32. ``slots``: as build takes them."""
        entries = INSTANCE_ENTRY.zeros(len(of.chosen))
        is_round = np.array([mesh.shape is not MeshShape.SURFACE for mesh in of.meshes], bool)[of.which]
        self.has_round_shapes = bool(is_round.any())
        if not len(entries):
            return entries, np.array([default_material], np.uint32)
        locate(entries, of.meshes, of.which)
        entries["pivot"] = self.placed.pivots
        for row in range(3):
            entries[f"row{row}"] = self.placed.rows[:, row]
        columns = self.columns
        entries["set_code"] = _set_codes(columns.visibility[of.chosen], columns.sets[of.chosen], is_round)
        numbers, lists = columns.materials[of.chosen], columns.material_lists
        if slots is not None:
            known: dict[tuple[int, ...], int] = {}
            numbers = numbered([slots[index] for index in of.chosen.tolist()], known)
            lists = list(known)
        materials = range(len(scene.materials)) if slots is None else range(_MOST_MATERIALS)
        return entries, place_slots(entries, numbers, lists, materials, default_material)

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
        passes_surfaces: bool,
    ) -> None:
        """Have places behind the world triangles for what instances need that are not expanded. ``which``: the mesh of
        each placement, ``placements``: the numbers of those instances; ``first_materials``: (n,) the material of each
        placement's first slot; ``passes_surfaces``: as build takes it."""
        self.instanced = None
        first = next_range(self.triangle_count)
        emitters = self._emitters_among(placements, scene)
        sizes = StageSizes.of(scene) if len(placements) else None
        lists = set() if sizes is None else traced_lists(sizes, passes_surfaces, len(emitters) > 0)
        self._hits.place(first, sizes, lists)
        mesh_of = which[placements]
        used = np.flatnonzero(np.bincount(mesh_of))
        one = np.zeros(len(meshes), np.int64)
        one[mesh_of[::-1]] = np.arange(len(mesh_of))[::-1]  # the first of each
        shared = [meshes[index] for index in used]
        self._objects.place(next_range(first + self._hits.count), shared, entries[placements[one[used]]])
        if not len(placements):
            return
        chosen = _as_slice(placements)
        self.instanced = InstancedMeshes(
            shared,
            self._objects.first_triangles,
            np.searchsorted(used, mesh_of),
            placements,
            self.placed.determinants[chosen] < 0.0,
            self.placed.matrices[chosen],
            entries[chosen],
            first_materials[chosen],
            self.placed.boxes[chosen],
            self.placed.versions[chosen],
            self.placed.version,
            world,
            HitPlaces(self._hits.first, self._hits.count, self._hits.origins.buffer, self._hits.first_hits),
            self._gather_hits,
            emitters,
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

    def _emitters_among(self, placements: np.ndarray, scene: Scene) -> np.ndarray:
        """(k,) int64, ascending, the places of those among placements (n,) with a material that may emit light."""
        if not len(placements):
            return placements
        glow = self.columns.have(glowing_materials(scene.materials))
        return np.flatnonzero(glow[require(self._placed_of).chosen[placements]])

    def listed_parts(self, count: int) -> list[slice]:
        """Parts of so many triangles that gather_listed takes at a time."""
        most = self._hits.listed_count
        return [slice(start, min(start + most, count)) for start in range(0, count, most)]

    def gather_listed(self, placements: np.ndarray, triangles: np.ndarray) -> np.ndarray:
        """Make world triangles of triangles (n,) of the meshes of placements (n,) that are not expanded, while no paths
        are traced; returns their numbers, (n,)."""
        outputs = self.triangles, self.attributes
        return self._hits.gather_listed(placements, triangles, self._inputs.blocks, outputs, self.center)

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

    def _enclose(self, swept: tuple[np.ndarray, np.ndarray] | None) -> None:
        """Find the bounds around the placements."""
        low, high = (np.full(3, np.inf), np.full(3, -np.inf)) if swept is None else swept
        boxes, is_near = self.placed.boxes, self.placed.is_near
        near = finite_bounds(boxes if is_near.all() else boxes[is_near])
        if near is not None:
            low, high = np.minimum(low, near[0]), np.maximum(high, near[1])
        for index in np.flatnonzero(~is_near):
            name = self.placements.instances[index].object_name
            log.warning("object %s has a matrix that is not finite; its triangles are left out", name)
        if not np.isfinite(low).all():
            low = high = np.zeros(3)
        self.bounds_low, self.bounds_high = low, high


def objects_of_most(instances: Iterable[Instance], lengths: Iterable[int]) -> str:
    """Names of those whose instances have the most triangles, so many each, and how many all of them have."""
    sums: Counter[str] = Counter()
    for instance, length in zip(instances, lengths, strict=True):
        sums[instance.object_name] += length
    return ", ".join(f'{count:,} of "{name}"' for name, count in sums.most_common(_OBJECTS_NAMED) if count)


def _set_codes(visibility: np.ndarray, sets: np.ndarray, is_round: np.ndarray) -> np.ndarray:
    """(n,) codes of shaders/common/light_sets.glsl. visibility: (n,) RayVisibility; sets: (n,) InstanceColumns.sets;
    is_round: (n,) bool, of which instances triangles stand for strands or points."""
    shadowless = visibility & int(RayVisibility.SHADOW) == 0
    codes = sets + _ONE_SIDED * is_round
    return np.where(shadowless, 1 + codes, -codes)


def _as_slice(indices: np.ndarray) -> np.ndarray | slice:
    """Ascending indices, at least one, as a slice where they follow each other, which copies nothing."""
    first, end = int(indices[0]), int(indices[-1]) + 1
    return slice(first, end) if end - first == len(indices) else indices
