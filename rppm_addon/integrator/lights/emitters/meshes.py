# SPDX-License-Identifier: GPL-3.0-or-later
"""Emitters of the meshes of instances that rays place in the world, in object space."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ....materials.tables import MaterialTables
from ....scene.meshes import Instance, MeshShape, RayVisibility
from ....scene.scene import Scene
from ...acceleration.instances import InstancedMeshes
from ...surfaces.geometry import Geometry
from ..light_links import LightLinkTable
from ..light_records import EMISSIVE_TRIANGLE, EMITTER_LINK_SHIFT, EmitterTrait
from ..light_tree import leaf_numbers, morton_order, tree_of, triangle_leaves
from .by_instance import AskEach, InstanceEmission
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


@dataclass(frozen=True)
class FoundEmitters:
    """Emitters of meshes, and which of these the instances have that rays place in the world, (n,) each."""

    meshes: list[MeshEmitters]
    which: np.ndarray
    """int64, -1 for none."""
    strengths: np.ndarray
    """(n,) what each instance emits, as a multiple of what the emitters of its mesh say."""
    traits: np.ndarray
    """int64, EmitterTraits that all triangles of an instance have, and its LightLink from EMITTER_LINK_SHIFT on."""

    @property
    def links(self) -> np.ndarray:
        """(n,) int64, LightLinks."""
        return self.traits >> EMITTER_LINK_SHIFT


@dataclass(frozen=True)
class _Known:
    """Findings of a mesh with some materials, which are kept."""

    sources: tuple
    """The mesh and the materials, which keeps their ids theirs."""
    emitters: MeshEmitters
    by_instance: InstanceEmission | None
    """Where the instances emit different light."""
    even_fraction: float
    """Fraction of the power that all instances emit alike."""


class EmissiveMeshes:
    """Finds the emitters of meshes, each once: instances that move change nothing of them."""

    def __init__(self) -> None:
        self._known: dict[tuple, _Known] = {}
        """By the ids of a mesh and of the materials of its slots, and whether smooth surfaces look for it."""

    def forget(self) -> None:
        """Find all anew, as materials emit otherwise."""
        self._known = {}

    def find(
        self,
        scene: Scene,
        geometry: Geometry,
        materials: MaterialTables,
        links: LightLinkTable,
        ask: Ask,
        ask_each: AskEach,
    ) -> FoundEmitters:
        """Return the emitters of the instances that rays place in the world."""
        known, self._known = self._known, {}
        instanced = geometry.instanced
        if instanced is None or not instanced.has_emitters:
            return FoundEmitters([], np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.int64))
        glowing, placed = EmissiveMaterials(scene, materials), geometry.placements.instances
        rows: dict[tuple, list[int]] = {}
        for number, placement in zip(
            instanced.emitters.tolist(), instanced.placements[instanced.emitters].tolist(), strict=True
        ):
            instance = placed[placement]
            rows.setdefault((instance.mesh, *instance.materials, is_seen_reflected(instance)), []).append(number)
        found: list[MeshEmitters] = []
        which = np.full(len(instanced.placements), -1, np.int64)
        strengths = np.ones(len(which))
        for numbers in rows.values():
            placements = instanced.placements[numbers]
            one = placed[placements[0]]
            sources = scene.meshes[one.mesh], *glowing.of_slots(one)
            key = *map(id, sources), is_seen_reflected(one)
            kept = known.get(key)
            if kept is None:
                kept = _find(scene, placements, _at(placements, placed), sources, glowing, ask, ask_each)
            elif kept.by_instance is not None:
                kept.by_instance.follow(_at(placements, placed), placements, ask_each)
            self._known[key] = kept
            if not len(kept.emitters.nodes):
                continue
            which[numbers] = len(found)
            found.append(kept.emitters)
            if kept.by_instance is not None:
                strengths[numbers] = kept.even_fraction + (1.0 - kept.even_fraction) * kept.by_instance.weights
        which[~(strengths > 0.0)] = -1
        return FoundEmitters(found, which, strengths, _instance_traits(geometry, instanced, links))


def _at(placements: np.ndarray, placed: list[Instance]) -> list[Instance]:
    """Return the instances of placements (n,)."""
    return [placed[placement] for placement in placements.tolist()]


def _instance_traits(geometry: Geometry, instanced: InstancedMeshes, links: LightLinkTable) -> np.ndarray:
    """(n,) FoundEmitters.traits."""
    rows = geometry.placed_meshes.chosen[instanced.placements]
    hidden = geometry.columns.visibility[rows] & int(RayVisibility.VOLUME_SCATTER) == 0
    result = np.zeros(len(rows), np.int64)
    for number in instanced.emitters[geometry.columns.are_linked[rows[instanced.emitters]]].tolist():
        linking = geometry.placements.instances[instanced.placements[number]].linking
        if linking is not None:
            hidden[number] |= not linking.lights_media
            result[number] = links.of_emitter(linking) << EMITTER_LINK_SHIFT
    return result + int(EmitterTrait.HIDDEN_FROM_MEDIA) * hidden


def _find(
    scene: Scene,
    placements: np.ndarray,
    instances: list[Instance],
    sources: tuple,
    glowing: EmissiveMaterials,
    ask: Ask,
    ask_each: AskEach,
) -> _Known:
    """Ask the materials of instances of a mesh for its emission."""
    instance = instances[0]
    mesh = scene.meshes[instance.mesh]
    corners = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float64)
    records = EMISSIVE_TRIANGLE.zeros(len(corners))
    area = areas_of(corners)
    records["area"] = np.where(np.isfinite(area), area, 0.0)
    slots, which = glowing.triangles_of(scene, instance)
    which = which[records["area"][which] > 0.0]
    kinds = slots[np.minimum(mesh.triangle_slots[which], len(slots) - 1)]
    varying, differs = glowing.vary(kinds), glowing.differ(kinds)
    alike = which[~differs]
    placed = corners[alike] @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
    records["radiance"][alike] = ask(
        int(placements[0]), alike, placed, records["area"][alike], kinds[~differs], varying[~differs]
    )
    records["traits"][which] = glowing.mesh_traits(instance, kinds) + int(EmitterTrait.UNEVEN) * varying
    by_instance, even_fraction = None, 1.0
    if differs.any():
        others = which[differs]
        even = float(np.abs(records["radiance"]).mean(axis=1) @ records["area"])
        by_instance = InstanceEmission.ask(
            corners[others], others, records["area"][others].astype(np.float64), instances, placements, ask_each
        )
        records["radiance"][others] = by_instance.radiance
        even_fraction = even / max(float(np.abs(records["radiance"]).mean(axis=1) @ records["area"]), 1e-300)
    sides = 2 if mesh.shape is MeshShape.SURFACE else 1
    return _Known(sources, mesh_emitters(records, corners, sides), by_instance, even_fraction)
