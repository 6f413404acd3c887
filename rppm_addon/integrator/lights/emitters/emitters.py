# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that emit light: how brightly, and how likely each is chosen."""

import functools
import math
from collections.abc import Callable

import moderngl
import numpy as np

from ....gl.buffer_sets import BufferSet, Part, StorageBuffer
from ....gl.buffers.records import Record
from ....gl.context.context import Context
from ....gl.programs.programs import ProgramLibrary
from ....materials.tables import MaterialTables
from ....scene.scene import Scene
from ...common.active_paths import ActivePaths, PathList
from ...common.records.closures import CLOSURE
from ...common.records.rays import HIT, NO_TRIANGLE, RAY
from ...common.require import require
from ...surfaces.geometry import Geometry
from ...surfaces.resolve import Resolve
from ..light_links import LightLinkTable
from ..light_records import EMISSIVE_TRIANGLE, EMITTER_LINK_SHIFT, LIGHT_NODE, EmitterTrait
from ..light_tree import leaf_numbers, morton_order, triangle_leaves
from .candidates import STEPS, candidates, chances
from .instances import EmitterInstances
from .meshes import EmissiveMeshes
from .programs import EmitterProgram

Record("EmittersParameters", photons="uint")
Record("MarkParameters", count="uint", first_triangle="uint", triangle_count="uint")

_POINTS = 8
"""Places of a triangle, on either side in turn, where an emission that varies is asked for."""
_CHUNK = 1 << 16
_MIN_FRACTION = 0.05
"""Fraction of a material's mean radiance that each of its triangles counts for at least, where emission varies: the
places where it is asked for may miss what shines."""

Emission = Callable[[np.ndarray, np.ndarray, int], np.ndarray]
"""Returns the mean radiance (n, 3) at so many places of triangles (n,), which have corners (n, 3, 3), seen straight
on."""


class Emitters(BufferSet):
    """The emissive triangles of a scene, and the emission of those whose material has it vary over the surface.

    ``triangles`` holds EMISSIVE_TRIANGLE records, ``count`` of world triangles, then those of the meshes of
    ``instances``; ``power`` (3,) is what all emit, W; ``leaves`` are those of the light tree, until that is built, of
    triangles and then of instances, but for the light sets; ``order`` is theirs along a curve, and ``links`` are the
    numbers of their LightLinks.
    """

    triangles = StorageBuffer("emissive triangles", EMISSIVE_TRIANGLE, texel_bytes=16, block="EmissiveTriangles")
    instances = Part(EmitterInstances)
    _leaf_numbers = StorageBuffer("leaves of emissive triangles", "uint")
    _rays = StorageBuffer("rays to emitters", RAY)
    _hits = StorageBuffer("places on emitters", HIT)
    _closures = StorageBuffer("closures of emitters", CLOSURE)
    _asked = PathList("rays to emitters to resolve", remedy="lower the resolution")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._mark = library.compute("lights/mark.comp")
        self._find = EmitterProgram(library, "lights/emitters.comp")
        self._tint_photons = library.compute("lights/tint_photons.comp")
        self._tint_contributions = library.compute("lights/tint_contributions.comp")
        self.count = 0
        self.power = np.zeros(3)
        self.leaves = LIGHT_NODE.zeros(0)
        self.order = np.zeros(0, np.int64)
        self.links = np.zeros(0, np.int64)
        self._varying = False
        self._world_triangles: moderngl.Buffer | None = None
        self.meshes = EmissiveMeshes()

    def build(
        self, scene: Scene, geometry: Geometry, materials: MaterialTables, resolve: Resolve, links: LightLinkTable
    ) -> None:
        """Ask the materials of all triangles that may emit for their radiance; those that do not are left out."""
        records, corners, kinds, varying, traits, numbers, sides = candidates(scene, geometry, materials, links)
        emission = functools.partial(self._emission, resolve)
        records["radiance"] = self._ask(emission, records["triangle"], corners, records["area"], kinds, varying)
        bright = records["radiance"].any(axis=1)
        if not bright.all():  # where all are, none of these many bytes is copied
            records, corners, varying, traits, numbers, sides = (
                column[bright] for column in (records, corners, varying, traits, numbers, sides)
            )
        self.leaves = triangle_leaves(records, corners.reshape(-1, 3, 3))
        del corners, kinds
        self._find_instances(scene, geometry, materials, resolve, links)
        if self.instances.are_there:
            self.leaves = np.concatenate([self.leaves, self.instances.leaves])
        self.links = np.concatenate([numbers, self.instances.links])
        self.order = morton_order(self.leaves)
        of_meshes = [mesh.records for mesh in self.instances.meshes]
        uneven = (bool((part["traits"] & EmitterTrait.UNEVEN).any()) for part in of_meshes)
        self._varying = bool(varying.any()) or any(uneven)
        self._world_triangles = geometry.triangles.buffer
        self.count = len(records)
        magnitudes = np.abs(records["radiance"])
        weights = magnitudes.mean(axis=1, dtype=np.float64) * records["area"]
        self.power = math.pi * (magnitudes.T.astype(np.float64) @ (sides * records["area"])) + self.instances.power
        self._choose(records, np.concatenate([weights, self.instances.weights]))
        records["traits"] = traits + EmitterTrait.UNEVEN * varying + (numbers << EMITTER_LINK_SHIFT)
        self._upload(records, of_meshes)
        self._mark_triangles(geometry)

    def _choose(self, records: np.ndarray, weights: np.ndarray) -> None:
        """Say how likely each of the world triangles is chosen, and each instance, by their weights."""
        if not len(weights):
            return
        steps, count, numbers = chances(weights), len(records), leaf_numbers(self.order)
        records["probability"] = steps[:count] / STEPS
        records["cumulated"] = np.cumsum(steps[:count]) / STEPS
        if self.instances.are_there:
            self.instances.choose(numbers[count:], steps[count:] / STEPS, steps[:count].sum() / STEPS, count)

    def _upload(self, records: np.ndarray, of_meshes: list[np.ndarray]) -> None:
        """Write the emissive triangles (EMISSIVE_TRIANGLE) of the world and of meshes, and the leaves of the former."""
        every = np.concatenate([records, *of_meshes]) if of_meshes else records
        self.triangles.upload(every if len(every) else EMISSIVE_TRIANGLE.zeros(1))
        numbers = leaf_numbers(self.order)[: self.count]
        self._leaf_numbers.upload(numbers if self.count else np.zeros(1, np.uint32))

    def _find_instances(
        self, scene: Scene, geometry: Geometry, materials: MaterialTables, resolve: Resolve, links: LightLinkTable
    ) -> None:
        def ask(placement: int, *columns: np.ndarray) -> np.ndarray:
            def emission(triangles: np.ndarray, corners: np.ndarray, points: int) -> np.ndarray:
                placements = np.full(len(triangles), placement)
                return self._emission_of_instances(resolve, geometry, placements, triangles, corners, points)

            return self._ask(emission, *columns)

        def ask_each(placements: np.ndarray, triangles: np.ndarray, corners: np.ndarray) -> np.ndarray:
            return np.abs(self._emission_of_instances(resolve, geometry, placements, triangles, corners, _POINTS))

        self.instances.place(geometry.instanced, self.meshes.find(scene, geometry, materials, links, ask, ask_each))

    def _mark_triangles(self, geometry: Geometry) -> None:
        """Have world triangles that emit carry their leaves and traits."""
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
        self,
        emission: Emission,
        triangles: np.ndarray,
        corners: np.ndarray,
        areas: np.ndarray,
        kinds: np.ndarray,
        varying: np.ndarray,
    ) -> np.ndarray:
        """(n, 3) radiance: one place is evaluated for each material that emits evenly, several for each triangle of the
        others."""
        radiance = np.zeros((len(triangles), 3))
        even = np.nonzero(~varying)[0]
        _, first, inverse = np.unique(kinds[even], return_index=True, return_inverse=True)
        if len(even):
            radiance[even] = emission(triangles[even[first]], corners[even[first]], 1)[inverse]
        uneven = np.nonzero(varying)[0]
        if len(uneven):
            radiance[uneven] = np.abs(emission(triangles[uneven], corners[uneven], _POINTS))
            for kind in np.unique(kinds[uneven]):
                of_kind = uneven[kinds[uneven] == kind]
                mean = np.average(radiance[of_kind], axis=0, weights=areas[of_kind])
                radiance[of_kind] = np.maximum(radiance[of_kind], _MIN_FRACTION * mean)
        return radiance

    def _emission_of_instances(
        self,
        resolve: Resolve,
        geometry: Geometry,
        placements: np.ndarray,
        triangles: np.ndarray,
        corners: np.ndarray,
        points: int,
    ) -> np.ndarray:
        """As _emission, of triangles (n,) of the meshes of instances that rays place in the world, by their
        placements (n,)."""
        parts = [
            self._emission(resolve, geometry.gather_listed(placements[part], triangles[part]), corners[part], points)
            for part in geometry.listed_parts(len(triangles))
        ]
        return np.concatenate([np.zeros((0, 3)), *parts])

    def _emission(self, resolve: Resolve, triangles: np.ndarray, corners: np.ndarray, points: int) -> np.ndarray:
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
        closures: moderngl.Buffer,
        active: ActivePaths,
        iteration: int,
    ) -> None:
        """Give shadow rays to emitters with varying emission the radiance of the place that they sampled. ``closures``
        are overwritten."""
        if not self._varying:
            return
        for buffer in (self._rays, self._hits):
            buffer.require_items(active.capacity)
        self._locate(shadow_rays, light_triangles, self._hits.buffer, active, photons=False)
        resolve.run(self._rays.buffer, self._hits.buffer, closures, self._asked, iteration, 0)
        self._asked.run(self._tint_contributions, {"Closures": closures, "Contributions": contributions})

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
            self._find.of(self.instances),
            {
                **self.instances.blocks,
                "EmissiveTriangles": self.triangles.buffer,
                "Rays": rays,
                "LightTriangles": light_triangles,
                "Triangles": require(self._world_triangles),
                "EmitterRays": self._rays.buffer,
                "EmitterHits": hits,
            },
            {"photons": photons},
        )
        self._asked.take(active, self._rays.buffer)
