# SPDX-License-Identifier: GPL-3.0-or-later
"""Emitters of the meshes of instances that rays place in the world, in object space."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ....materials.tables import MaterialTables
from ....scene.meshes import Instance, MeshShape
from ....scene.scene import Scene
from ...surfaces.geometry import Geometry
from ..light_records import EMISSIVE_TRIANGLE, EmitterTrait
from ..light_tree import leaf_numbers, morton_order, tree_of, triangle_leaves
from .candidates import STEPS, EmissiveMaterials, areas_of, chances, is_seen_reflected

Ask = Callable[[int, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Returns the radiance (n, 3) of triangles of an instance: its placement, the triangles (n,), their corners (n, 3, 3)
in the world, areas, materials, and whether their emission varies."""


@dataclass(frozen=True)
class MeshEmitters:
    """Emissive triangles of a mesh with some materials, in object space."""

    records: np.ndarray
    """(triangles,) EMISSIVE_TRIANGLE records, whose ``triangle`` is the leaf; probabilities are those within the mesh,
    and 0 where a triangle emits nothing."""
    nodes: np.ndarray
    """(2 leaves,) LIGHT_NODE records of the light tree, whose members are triangles of the mesh."""
    power: np.ndarray
    """(3,) float64, what it would emit with an identity matrix, W."""
    normals: np.ndarray
    """(3, 3) float64, mean of the outer products of normals with themselves, weighted by power."""


def mesh_emitters(records: np.ndarray, corners: np.ndarray, sides: int) -> MeshEmitters:
    """Return the emitters of a mesh by EMISSIVE_TRIANGLE records of all its triangles, with radiance, area and traits.

    corners: (n, 3, 3) in object space; sides: number of sides that shine.
    """
    magnitudes = np.abs(records["radiance"]).astype(np.float64)
    bright = np.flatnonzero(magnitudes.any(axis=1) & (records["area"] > 0))
    weights = magnitudes[bright].mean(axis=1) * records["area"][bright]
    leaves = triangle_leaves(records[bright], corners[bright])
    leaves["member"], leaves["light_sets"] = bright, 0xFFFFFFFF
    order = morton_order(leaves)
    records["triangle"] = 0
    steps = np.zeros(len(records))
    if len(bright):
        steps[bright] = chances(weights)
        records["triangle"][bright] = leaf_numbers(order)
    records["probability"] = steps / STEPS
    records["cumulated"] = np.cumsum(steps) / STEPS
    axes = leaves["axis"].astype(np.float64)
    total = max(weights.sum(), 1e-300)
    return MeshEmitters(
        records,
        tree_of(leaves, order),
        np.pi * sides * (magnitudes.T @ records["area"].astype(np.float64)),
        np.einsum("n,ni,nj->ij", weights, axes, axes) / total,
    )


class EmissiveMeshes:
    """Finds the emitters of meshes, each once: instances that move change nothing of them."""

    def __init__(self) -> None:
        self._known: dict[tuple, tuple[tuple, MeshEmitters]] = {}
        """By the ids of a mesh and of the materials of its slots, and whether smooth surfaces look for it: these, which
        keeps the ids theirs, and the emitters."""

    def forget(self) -> None:
        """Find all anew, as materials emit otherwise."""
        self._known = {}

    def find(
        self, scene: Scene, geometry: Geometry, materials: MaterialTables, ask: Ask
    ) -> tuple[list[MeshEmitters], np.ndarray]:
        """Return the emitters of meshes, and (instances,) int64 which of these each instance has that rays place in the
        world, -1 for none."""
        instanced = geometry.instanced
        if instanced is None or not instanced.has_emitters:
            self._known = {}
            return [], np.zeros(0, np.int64)
        glowing = EmissiveMaterials(scene, materials)
        known, self._known = self._known, {}
        found: list[MeshEmitters] = []
        places: dict[tuple, int] = {}
        which = np.full(len(instanced.placements), -1, np.int64)
        for number in instanced.emitters.tolist():
            placement = int(instanced.placements[number])
            instance = geometry.placements.instances[placement]
            key = instance.mesh, tuple(instance.materials), is_seen_reflected(instance)
            if key not in places:
                sources = scene.meshes[instance.mesh], *glowing.of_slots(instance)
                source_key = *map(id, sources), is_seen_reflected(instance)
                _, emitters = known.get(source_key) or (None, _find(scene, placement, instance, glowing, ask))
                self._known[source_key] = sources, emitters
                places[key] = len(found) if len(emitters.nodes) else -1
                found += [emitters] if len(emitters.nodes) else []
            which[number] = places[key]
        return found, which


def _find(scene: Scene, placement: int, instance: Instance, glowing: EmissiveMaterials, ask: Ask) -> MeshEmitters:
    """Ask the materials of an instance for the emission of its mesh."""
    mesh = scene.meshes[instance.mesh]
    corners = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float64)
    records = EMISSIVE_TRIANGLE.zeros(len(corners))
    area = areas_of(corners)
    records["area"] = np.where(np.isfinite(area), area, 0.0)
    slots, which = glowing.triangles_of(scene, instance)
    which = which[records["area"][which] > 0.0]
    kinds = slots[np.minimum(mesh.triangle_slots[which], len(slots) - 1)]
    varying = glowing.vary(kinds)
    placed = corners[which] @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
    records["radiance"][which] = ask(placement, which, placed, records["area"][which], kinds, varying)
    records["traits"][which] = glowing.traits(instance, kinds) + int(EmitterTrait.UNEVEN) * varying
    return mesh_emitters(records, corners, 2 if mesh.shape is MeshShape.SURFACE else 1)
