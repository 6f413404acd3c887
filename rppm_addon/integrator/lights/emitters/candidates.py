# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that may emit light, by what is known of their materials before these are asked."""

import contextlib
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import DTypeLike

from ....materials.tables import MaterialTables
from ....materials.traits.emitted import Emits, asks_for_path, emits_alike
from ....scene.errors import DeviceError
from ....scene.materials import Material
from ....scene.meshes import Instance, MeshShape, RayVisibility
from ....scene.scene import Scene
from ...surfaces.geometry import Geometry, objects_of_most
from ...surfaces.placements import Placement
from ..light_links import NO_LINK, LightLinkTable
from ..light_records import EMISSIVE_TRIANGLE, EmitterTrait
from ..light_tree import LightTree

_SEEN_REFLECTED = RayVisibility.GLOSSY | RayVisibility.SHADOW
"""Ray visibility of emissive objects that smooth surfaces look for: the nearest one hides those behind it."""
STEPS = 1 << 24
"""Probabilities are multiples of 2^-24: random numbers have no more steps."""


class EmissiveMaterials:
    """Materials of a scene that may emit light."""

    def __init__(self, scene: Scene, materials: MaterialTables) -> None:
        self._materials = scene.materials
        self._emits, self._count = materials.emits, len(scene.materials)
        self._varies = np.array([emits is Emits.VARYING for emits in self._emits], bool)
        self._differs = np.array([not emits_alike(material.graph) for material in scene.materials], bool)
        self._dark = {index for index in range(self._count) if self._emits[index] is Emits.NOTHING}
        self._by_path = [
            m for m, material in enumerate(scene.materials) if m not in self._dark and asks_for_path(material.graph)
        ]

    def are_on(self, instance: Instance) -> bool:
        """Return True where triangles of an instance may emit."""
        return not (instance.materials and self._dark.issuperset(instance.materials))

    def of_slots(self, instance: Instance) -> list[Material | None]:
        """Materials of an instance's slots, None where the scene does not have one."""
        return [self._materials[m] if 0 <= m < self._count else None for m in instance.materials]

    def triangles_of(self, scene: Scene, instance: Instance) -> tuple[np.ndarray, np.ndarray]:
        """Materials of an instance's slots, -1 where there is none, and the mesh's triangles that may emit, by
        number."""
        slots = np.array([m if 0 <= m < self._count else -1 for m in instance.materials] or [-1])
        emits = np.array([self._emits[m] is not Emits.NOTHING for m in slots])
        if not emits.any():
            return slots, np.zeros(0, np.int64)
        return slots, np.nonzero(emits[np.minimum(scene.meshes[instance.mesh].triangle_slots, len(slots) - 1)])[0]

    def differ(self, kinds: np.ndarray) -> np.ndarray:
        """(n,) bool, whether instances of a mesh with materials (n,) may emit different light."""
        return self._differs[kinds]

    def vary(self, kinds: np.ndarray) -> np.ndarray:
        """(n,) bool, whether the emission of materials (n,) varies with place or direction."""
        return self._varies[kinds]

    def traits(self, instance: Instance, kinds: np.ndarray) -> np.ndarray:
        """(n,) EmitterTraits of triangles of an instance with materials (n,), but for UNEVEN."""
        traits = self.mesh_traits(instance, kinds)
        links_leave_out_media = instance.linking is not None and not instance.linking.lights_media
        if links_leave_out_media or not instance.visibility & RayVisibility.VOLUME_SCATTER:
            traits += int(EmitterTrait.HIDDEN_FROM_MEDIA)
        return traits

    def mesh_traits(self, instance: Instance, kinds: np.ndarray) -> np.ndarray:
        """(n,) those of the same that follow from the materials, and from is_seen_reflected. Smooth surfaces look for
        no emission that depends on the path that comes there."""
        seen = is_seen_reflected(instance)
        return int(EmitterTrait.REFLECTED) * (seen & np.isin(kinds, self._by_path, invert=True))


def is_seen_reflected(instance: Instance) -> bool:
    """Return True where smooth surfaces look for the emission of an instance."""
    return bool(instance.visibility & _SEEN_REFLECTED == _SEEN_REFLECTED)


def areas_of(corners: np.ndarray) -> np.ndarray:
    """(n,) areas of triangles with corners (n, 3, 3)."""
    return 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)


def chances(weights: np.ndarray) -> np.ndarray:
    """(n,) int64 steps of 2^24 in proportion to positive weights, each at least one."""
    steps = np.maximum(1, np.floor(weights / weights.sum() * max(STEPS - len(weights), 1))).astype(np.int64)
    steps[np.argmax(steps)] += STEPS - steps.sum()
    return steps


def refuse_too_many(scene: Scene, geometry: Geometry, materials: MaterialTables, refuse: Callable[[int], None]) -> None:
    """Have ``refuse`` judge how many triangles may emit, before anything is asked of them; they are counted only where
    not all of the scene have room. Raises its DeviceError, or one for more than can be chosen from, with the objects
    that have the most."""

    def judge(count: int) -> None:
        if count > STEPS:
            raise DeviceError(f"no more than {STEPS:,} triangles can emit light; {LightTree.remedy}")
        refuse(count)

    of_instances = 0
    if geometry.instanced is not None:
        shining = np.unique(geometry.instanced.which[geometry.instanced.emitters]).tolist()
        triangles = sum(geometry.instanced.meshes[mesh].triangle_count for mesh in shining)
        of_instances = len(geometry.instanced.emitters) + triangles
    with contextlib.suppress(DeviceError):
        return judge(geometry.triangle_count + of_instances)
    glowing = EmissiveMaterials(scene, materials)
    known_counts: dict[tuple[int, ...], int] = {}
    instances = [placement.instance for placement in geometry.expanded]
    keys = [(instance.mesh, *instance.materials) for instance in instances]
    for key, instance in zip(keys, instances):
        if key not in known_counts:
            known_counts[key] = len(glowing.triangles_of(scene, instance)[1])
    counts = [known_counts[key] for key in keys]
    try:
        judge(sum(counts) + of_instances)
    except DeviceError as error:
        most = objects_of_most(instances, counts)
        raise DeviceError(f"{error} (of {sum(counts):,} that do, instances counted each: {most})") from error


def candidates(
    scene: Scene, geometry: Geometry, materials: MaterialTables, links: LightLinkTable
) -> Iterator[np.ndarray]:
    """Return an iterator over the arrays that _may_emit gives, each joined over all instances."""
    glowing = EmissiveMaterials(scene, materials)
    found = [
        _may_emit(scene, placement, glowing, links)
        for placement in geometry.expanded
        if glowing.are_on(placement.instance)
    ]
    kinds_of_parts: tuple[DTypeLike, ...] = (
        EMISSIVE_TRIANGLE.dtype, np.float64, np.int64, bool, np.int64, np.int64, np.int64
    )  # fmt: skip
    columns = list(zip(*found)) if found else [[np.zeros((0,), kind)] for kind in kinds_of_parts]
    del found
    return (np.concatenate(columns.pop(0)) for _ in kinds_of_parts)  # each is given back once it is joined


def _may_emit(
    scene: Scene, placement: Placement, glowing: EmissiveMaterials, links: LightLinkTable
) -> tuple[np.ndarray, ...]:
    """Return columns for the triangles of one instance that may emit: records without radiance, corners (n, 3, 3) in
    meters, material, whether its emission varies, its other EmitterTraits, its LightLink, and how many sides shine."""
    instance = placement.instance
    mesh = scene.meshes[instance.mesh]
    slots, which = glowing.triangles_of(scene, instance)
    corners = mesh.positions[mesh.corner_vertices[mesh.triangle_corners[which]]].astype(np.float64)
    corners = corners @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
    area = areas_of(corners)
    good = np.isfinite(area) & (area > 0)
    which, corners = which[good], corners[good]
    records = EMISSIVE_TRIANGLE.zeros(len(which))
    records["triangle"], records["area"] = placement.first_triangle + which, area[good]
    kinds = slots[np.minimum(mesh.triangle_slots[which], len(slots) - 1)]
    link = links.of_emitter(instance.linking) if len(records) else NO_LINK
    sides = np.full(len(records), 2 if mesh.shape is MeshShape.SURFACE else 1)
    traits = glowing.traits(instance, kinds)
    return records, corners, kinds, glowing.vary(kinds), traits, np.full(len(records), link), sides
