# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that emit light: how brightly, and how likely each is chosen."""

import contextlib
import math
from collections.abc import Callable, Iterator

import moderngl
import numpy as np
from numpy.typing import DTypeLike

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...materials.tables import MaterialTables
from ...materials.traits.emitted import Emits, asks_for_path
from ...scene.errors import DeviceError
from ...scene.meshes import Instance, MeshShape, RayVisibility
from ...scene.scene import Scene
from ..common.active_paths import ActivePaths, PathList
from ..common.records.closures import CLOSURE
from ..common.records.rays import HIT, NO_TRIANGLE, RAY
from ..common.require import require
from ..surfaces.geometry import Geometry, objects_of_most
from ..surfaces.placements import Placement
from ..surfaces.resolve import Resolve
from .light_links import NO_LINK, LightLinkTable
from .light_records import EMISSIVE_TRIANGLE, EMITTER_LINK_SHIFT, LIGHT_NODE, EmitterTrait
from .light_tree import LightTree, leaf_numbers, morton_order, triangle_leaves

Record("EmittersParameters", photons="uint")
Record("MarkParameters", count="uint", first_triangle="uint", triangle_count="uint")

_POINTS = 8
"""Places of a triangle, on either side in turn, where an emission that varies is asked for."""
_CHUNK = 1 << 16
_MIN_FRACTION = 0.05
"""Fraction of a material's mean radiance that each of its triangles counts for at least, where emission varies: the
places where it is asked for may miss what shines."""
_SEEN_REFLECTED = RayVisibility.GLOSSY | RayVisibility.SHADOW
"""Ray visibility of emissive objects that smooth surfaces look for: the nearest one hides those behind it."""
_STEPS = 1 << 24
"""Probabilities are multiples of 2^-24: random numbers have no more steps."""


class Emitters(BufferSet):
    """The emissive triangles of a scene, and the emission of those whose material has it vary over the surface.

    ``triangles`` holds EMISSIVE_TRIANGLE records, ``count`` of them; ``power`` (3,) is what they emit, W; ``leaves``
    are theirs of the light tree, until that is built, but for the light sets, ``order`` (count,) is that of the leaves
    along a curve, and ``links`` (count,) are the numbers of their LightLinks.
    """

    triangles = StorageBuffer("emissive triangles", EMISSIVE_TRIANGLE, texel_bytes=16, block="EmissiveTriangles")
    _leaf_numbers = StorageBuffer("leaves of emissive triangles", "uint")
    _rays = StorageBuffer("rays to emitters", RAY)
    _hits = StorageBuffer("places on emitters", HIT)
    _closures = StorageBuffer("closures of emitters", CLOSURE)
    _asked = PathList("rays to emitters to resolve", remedy="lower the resolution")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._mark = library.compute("lights/mark.comp")
        self._find = library.compute("lights/emitters.comp")
        self._tint_photons = library.compute("lights/tint_photons.comp")
        self._tint_contributions = library.compute("lights/tint_contributions.comp")
        self.count = 0
        self.power = np.zeros(3)
        self.leaves = LIGHT_NODE.zeros(0)
        self.order = np.zeros(0, np.int64)
        self.links = np.zeros(0, np.int64)
        self._varying = False
        self._world_triangles: moderngl.Buffer | None = None

    def build(
        self, scene: Scene, geometry: Geometry, materials: MaterialTables, resolve: Resolve, links: LightLinkTable
    ) -> None:
        """Ask the materials of all triangles that may emit for their radiance; those that do not are left out."""
        records, corners, kinds, varying, traits, numbers, sides = _candidates(scene, geometry, materials, links)
        self._ask(records, corners, kinds, varying, resolve)
        bright = records["radiance"].any(axis=1)
        if not bright.all():  # where all are, none of these many bytes is copied
            records, corners, varying, traits, numbers, sides = (
                column[bright] for column in (records, corners, varying, traits, numbers, sides)
            )
        self.links = numbers
        self.leaves = triangle_leaves(records, corners.reshape(-1, 3, 3))
        self.order = morton_order(self.leaves)
        del corners, kinds
        self._varying = bool(varying.any())
        self._world_triangles = geometry.triangles.buffer
        self.count = len(records)
        magnitudes = np.abs(records["radiance"])
        weights = magnitudes.mean(axis=1, dtype=np.float64) * records["area"]
        self.power = math.pi * (magnitudes.T.astype(np.float64) @ (sides * records["area"]))
        if self.count:
            steps = chances(weights)
            records["probability"] = steps / _STEPS
            records["cumulated"] = np.cumsum(steps) / _STEPS
            records["traits"] = traits + EmitterTrait.UNEVEN * varying + (self.links << EMITTER_LINK_SHIFT)
        self.triangles.upload(records if self.count else EMISSIVE_TRIANGLE.zeros(1))
        self._leaf_numbers.upload(leaf_numbers(self.order) if self.count else np.zeros(1, np.uint32))
        for part in geometry.triangles.ranges(geometry.triangle_count):
            self._mark.run(
                self.count,
                {
                    "EmissiveTriangles": self.triangles.buffer,
                    "EmitterLeaves": self._leaf_numbers.buffer,
                    "Triangles": part,
                },
                {"count": self.count, "first_triangle": part.first, "triangle_count": part.count},
            )

    def _ask(
        self, records: np.ndarray, corners: np.ndarray, kinds: np.ndarray, varying: np.ndarray, resolve: Resolve
    ) -> None:
        """Fill in the radiance: one place is evaluated for each material that emits evenly, several for each triangle
        of the others."""
        radiance = np.zeros((len(records), 3))
        even = np.nonzero(~varying)[0]
        _, first, inverse = np.unique(kinds[even], return_index=True, return_inverse=True)
        if len(even):
            radiance[even] = self._emission(records["triangle"][even[first]], corners[even[first]], 1, resolve)[inverse]
        uneven = np.nonzero(varying)[0]
        if len(uneven):
            radiance[uneven] = np.abs(self._emission(records["triangle"][uneven], corners[uneven], _POINTS, resolve))
            for kind in np.unique(kinds[uneven]):
                of_kind = uneven[kinds[uneven] == kind]
                mean = np.average(radiance[of_kind], axis=0, weights=records["area"][of_kind])
                radiance[of_kind] = np.maximum(radiance[of_kind], _MIN_FRACTION * mean)
        records["radiance"] = radiance

    def _emission(self, triangles: np.ndarray, corners: np.ndarray, points: int, resolve: Resolve) -> np.ndarray:
        """(n, 3) mean radiance at ``points`` places of each triangle, seen straight on."""
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        total = np.zeros((len(triangles), 3))
        for point in range(points):
            u = np.array([(point + 0.5) / points, (0.5 + point * 0.6180339887) % 1.0])
            root = math.sqrt(u[0])
            b1, b2 = (1 / 3, 1 / 3) if points == 1 else (root * (1 - u[1]), root * u[1])
            for start in range(0, len(triangles), _CHUNK):
                part = slice(start, start + _CHUNK)
                total[part] += self._emission_at(triangles[part], normals[part] * (-1) ** point, b1, b2, resolve)
        return total / points

    def _emission_at(
        self, triangles: np.ndarray, viewers: np.ndarray, b1: float, b2: float, resolve: Resolve
    ) -> np.ndarray:
        count = len(triangles)
        rays, hits = RAY.zeros(count), HIT.zeros(count)
        rays["direction"], rays["maximum_distance"], rays["source_triangle"] = -viewers, 1.0, NO_TRIANGLE
        hits["triangle"], hits["b1"], hits["b2"], hits["distance"] = triangles, b1, b2, 1.0
        self._rays.upload(rays)
        self._hits.upload(hits)
        self._closures.require_items(count)
        self._asked.fill(count)
        resolve.run(self._rays.buffer, self._hits.buffer, self._closures.buffer, self._asked, 0, 0)
        emission = self._closures.read(CLOSURE.dtype, count)["emission"]
        return np.where(np.isfinite(emission), emission, 0.0)

    def tint_photons(
        self,
        resolve: Resolve,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        closures: moderngl.Buffer,
        photon_paths: moderngl.Buffer,
        active: ActivePaths,
        iteration: int,
    ) -> None:
        """Give photons that leave emitters with varying emission the radiance of their place and direction.

        ``hits`` and ``closures`` are overwritten.
        """
        if not self._varying:
            return
        self._rays.require_items(active.capacity)
        self._locate(rays, rays, hits, active, photons=True)
        resolve.run(self._rays.buffer, hits, closures, self._asked, iteration, 0)
        self._asked.run(self._tint_photons, {"Closures": closures, "PhotonPaths": photon_paths})

    def tint_contributions(
        self,
        resolve: Resolve,
        shadow_rays: moderngl.Buffer,
        light_triangles: moderngl.Buffer,
        contributions: moderngl.Buffer,
        active: ActivePaths,
        iteration: int,
    ) -> None:
        """Give shadow rays to emitters with varying emission the radiance of the place that they sampled."""
        if not self._varying:
            return
        for buffer in (self._rays, self._hits, self._closures):
            buffer.require_items(active.capacity)
        self._locate(shadow_rays, light_triangles, self._hits.buffer, active, photons=False)
        resolve.run(self._rays.buffer, self._hits.buffer, self._closures.buffer, self._asked, iteration, 0)
        self._asked.run(self._tint_contributions, {"Closures": self._closures.buffer, "Contributions": contributions})

    def _locate(
        self,
        rays: moderngl.Buffer,
        light_triangles: moderngl.Buffer,
        hits: moderngl.Buffer,
        active: ActivePaths,
        photons: bool,
    ) -> None:
        """Rays that look at the emitters' places, and the places as hits; those that are to be asked are listed."""
        active.run(
            self._find,
            {
                "Rays": rays,
                "LightTriangles": light_triangles,
                "Triangles": require(self._world_triangles),
                "EmitterRays": self._rays.buffer,
                "EmitterHits": hits,
            },
            {"photons": photons},
        )
        self._asked.take(active, self._rays.buffer)


def chances(weights: np.ndarray) -> np.ndarray:
    """(n,) int64 steps of 2^24 in proportion to positive weights, each at least one."""
    steps = np.maximum(1, np.floor(weights / weights.sum() * max(_STEPS - len(weights), 1))).astype(np.int64)
    steps[np.argmax(steps)] += _STEPS - steps.sum()
    return steps


def refuse_too_many(scene: Scene, geometry: Geometry, materials: MaterialTables, refuse: Callable[[int], None]) -> None:
    """Have ``refuse`` judge how many triangles may emit, before anything is asked of them; they are counted only where
    not all of the scene have room. Raises its DeviceError, or one for more than can be chosen from, with the objects
    that have the most."""

    def judge(count: int) -> None:
        if count > _STEPS:
            raise DeviceError(f"no more than {_STEPS:,} triangles can emit light; {LightTree.remedy}")
        refuse(count)

    with contextlib.suppress(DeviceError):
        return judge(geometry.triangle_count)
    known_counts: dict[tuple[int, ...], int] = {}
    instances = [placement.instance for placement in geometry.placements]
    keys = [(instance.mesh, *instance.materials) for instance in instances]
    for key, instance in zip(keys, instances):
        if key not in known_counts:
            known_counts[key] = len(_emitting(scene, instance, materials)[1])
    counts = [known_counts[key] for key in keys]
    try:
        judge(sum(counts))
    except DeviceError as error:
        most = objects_of_most(instances, counts)
        raise DeviceError(f"{error} (of {sum(counts):,} that do, instances counted each: {most})") from error


def _candidates(
    scene: Scene, geometry: Geometry, materials: MaterialTables, links: LightLinkTable
) -> Iterator[np.ndarray]:
    """Return an iterator over the arrays that _may_emit gives, each joined over all instances."""
    dark = {index for index in range(len(scene.materials)) if materials.emits[index] is Emits.NOTHING}
    by_path = {m for m, material in enumerate(scene.materials) if m not in dark and asks_for_path(material.graph)}
    found = [
        _may_emit(scene, placement, materials, by_path, links)
        for placement in geometry.placements
        if not (placement.instance.materials and dark.issuperset(placement.instance.materials))
    ]
    kinds_of_parts: tuple[DTypeLike, ...] = (
        EMISSIVE_TRIANGLE.dtype, np.float64, np.int64, bool, np.int64, np.int64, np.int64
    )  # fmt: skip
    columns = list(zip(*found)) if found else [[np.zeros((0,), kind)] for kind in kinds_of_parts]
    del found
    return (np.concatenate(columns.pop(0)) for _ in kinds_of_parts)  # each is given back once it is joined


def _emitting(scene: Scene, instance: Instance, materials: MaterialTables) -> tuple[np.ndarray, np.ndarray]:
    """Materials of an instance's slots, -1 where there is none, and the mesh's triangles that may emit, by number."""
    slots = np.array([m if 0 <= m < len(scene.materials) else -1 for m in instance.materials] or [-1])
    emits = np.array([materials.emits[m] is not Emits.NOTHING for m in slots])
    if not emits.any():
        return slots, np.zeros(0, np.int64)
    return slots, np.nonzero(emits[np.minimum(scene.meshes[instance.mesh].triangle_slots, len(slots) - 1)])[0]


def _may_emit(
    scene: Scene, placement: Placement, materials: MaterialTables, by_path: set[int], links: LightLinkTable
) -> tuple[np.ndarray, ...]:
    """Return columns for the triangles of one instance that may emit: records without radiance, corners (n, 3, 3) in
    meters, material, whether its emission varies, its other EmitterTraits, its LightLink, and how many sides shine.
    Smooth surfaces look for no emission that depends on the path that comes there."""
    instance = placement.instance
    mesh = scene.meshes[instance.mesh]
    slots, which = _emitting(scene, instance, materials)
    corners = mesh.positions[mesh.corner_vertices[mesh.triangle_corners[which]]].astype(np.float64)
    corners = corners @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    good = np.isfinite(area) & (area > 0)
    which, corners = which[good], corners[good]
    records = EMISSIVE_TRIANGLE.zeros(len(which))
    records["triangle"], records["area"] = placement.first_triangle + which, area[good]
    kinds = slots[np.minimum(mesh.triangle_slots[which], len(slots) - 1)]
    varying = np.array([materials.emits[m] is Emits.VARYING for m in kinds], bool)
    seen = instance.visibility & _SEEN_REFLECTED == _SEEN_REFLECTED
    traits = int(EmitterTrait.REFLECTED) * (seen & np.isin(kinds, list(by_path), invert=True))
    if not instance.visibility & RayVisibility.VOLUME_SCATTER:
        traits += int(EmitterTrait.HIDDEN_FROM_MEDIA)
    link = links.of_emitter(instance.linking) if len(records) else NO_LINK
    sides = np.full(len(records), 2 if mesh.shape is MeshShape.SURFACE else 1)
    return records, corners, kinds, varying, traits, np.full(len(records), link), sides
