# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes whose vertices are moved by what the nodes of their materials give there, as Cycles does before a render."""

import dataclasses
import functools
import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...materials.tables import MaterialTables
from ...scene.meshes import UNDISPLACED, AttributeDomain, Instance, Mesh, MeshAttribute, MeshShape
from ...scene.motion import Deformation, Shutter
from ...scene.scene import Scene
from ...scene.storage.sharing import same_bits
from .dicing import MOST_TRIANGLES, DicedMesh, parts_of_edges, rounded_parts
from .displaced_normals import displaced_normals
from .displaced_vertices import DisplacedVertices

_Slots = tuple[tuple[int, bool] | None, ...]
"""Displacing material of each slot: its index, and whether it is bumped as well; None where the slot has none."""


@dataclass
class _Shape:
    """A mesh with displacing materials, and what became of it."""

    source: Mesh
    slots: _Slots
    instance: Instance
    """The first that has it: of this one nodes are asked, whatever the others are."""
    parts: int
    """Into which edges are divided before."""
    offsets: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), np.float32))
    """(vertices, 3) object space."""
    displaced: Mesh | None = None
    deformations: dict[int, tuple[Deformation, Deformation]] = field(default_factory=dict)
    """By the id of a deformation, it and that of the displaced mesh."""
    placed: dict[int, tuple[Instance, Instance]] = field(default_factory=dict)
    """By the id of an instance, it and the same of the displaced mesh, where others have the mesh as it was."""

    @functools.cached_property
    def diced(self) -> DicedMesh | None:
        """The source divided; None where it stays whole."""
        return DicedMesh(self.source, self.parts) if self.parts > 1 else None

    @property
    def mesh(self) -> Mesh:
        """Mesh that is displaced: the diced one, or the source where it stays whole."""
        return self.source if self.diced is None else self.diced.mesh

    def normals(self, before: np.ndarray, after: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """(corners, 3) as displaced_normals gives them."""
        by_slot = np.array([(slot is not None, slot is not None and slot[1]) for slot in self.slots])
        displaced, bumped = by_slot[np.minimum(self.mesh.triangle_slots, len(by_slot) - 1)].T
        return displaced_normals(self.mesh, displaced & ~bumped, bumped, before, after, normals)

    def keep(self, members: set[int]) -> None:
        """Forget what was made of instances and deformations whose ids are not among these."""
        self.deformations = {key: made for key, made in self.deformations.items() if key in members}
        self.placed = {key: made for key, made in self.placed.items() if key in members}


class Displacement:
    """Displaces the meshes of scenes. What did not change is the same object from one scene to the next."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        self._context, self._library = context, library
        self._shapes: dict[tuple[int, _Slots], _Shape] = {}
        """By the id of the mesh, and materials."""
        self._slots: dict[int, tuple[int, bool]] = {}
        """Displacing materials of the last scene, as _Slots has them, by index."""
        self.warnings: list[str] = []
        """Warnings of what is divided less than is asked for in the last scene; this follows from camera and meshes."""

    def displaced(self, scene: Scene, materials: MaterialTables, renewed: bool) -> Scene:
        """The scene with its meshes displaced, and their shapes at other times; itself where nothing is displaced.

        materials: built for the scene; renewed: since the scene before. Programs that the driver refuses are reported
        in scene.warnings. Raises DeviceError.
        """
        self.warnings = []
        self._slots = {index: (index, graph.keeps_normals) for index, graph in materials.displacing.items()}
        users = _users(scene, self._slots)
        known, self._shapes = self._shapes, {}
        stale = []
        for mesh, slots, members in _displaced(users):
            source, first = scene.meshes[mesh], scene.instances[members[0]]
            parts, shape = self._parts(scene, source, members), known.get((id(source), slots))
            if shape is None or shape.parts != parts:
                shape = _Shape(source, slots, first, parts)
            if renewed or shape.displaced is None or shape.instance is not first:
                shape.instance = first
                stale.append(shape)
            self._shapes[id(source), slots] = shape
        if not self._shapes:
            return scene
        self._evaluate(scene, materials, stale)
        return self._with_shapes(scene, users)

    def as_known(self, scene: Scene) -> Scene:
        """The scene with those of its meshes displaced that the last one had; itself where there are none."""
        users = _users(scene, self._slots)
        unknown = {mesh for mesh, slots, _ in _displaced(users) if (id(scene.meshes[mesh]), slots) not in self._shapes}
        users = {mesh: by_slots for mesh, by_slots in users.items() if mesh not in unknown}
        return self._with_shapes(scene, users) if users else scene

    def _evaluate(self, scene: Scene, materials: MaterialTables, shapes: list[_Shape]) -> None:
        if not shapes:
            return
        vertices = DisplacedVertices(self._context, self._library)
        try:
            found = vertices.offsets(scene, materials, [(shape.mesh, shape.instance) for shape in shapes])
        finally:
            vertices.release()
        for shape, offsets in zip(shapes, found, strict=True):
            if shape.displaced is None or not same_bits(offsets, shape.offsets):
                shape.offsets, shape.displaced = offsets, _moved(shape, offsets)
                shape.deformations, shape.placed = {}, {}

    def _parts(self, scene: Scene, mesh: Mesh, members: list[int]) -> int:
        """Into how many parts the edges of a mesh are divided that these instances have."""
        triangles = mesh.triangle_count * len(members)
        if mesh.dicing is None or triangles == 0 or scene.camera.texels is not None:  # texels know them by number
            return 1
        instances = [scene.instances[member] for member in members]
        wanted = parts_of_edges(mesh, instances, scene.camera, scene.dicing_rate)
        parts = rounded_parts(wanted, triangles)
        if parts < wanted:
            self.warnings.append(
                f'Object "{instances[0].object_name}": Adaptive Subdivision leaves edges {wanted / parts:.1f} times as '
                f"long as it is asked for, as it makes no more than {MOST_TRIANGLES} triangles; raise its Pixel Size "
                "or the Dicing Rate"
            )
        return parts

    def _with_shapes(self, scene: Scene, users: "_Users") -> Scene:
        meshes, instances = list(scene.meshes), list(scene.instances)
        places: dict[int, list[tuple[int, _Shape]]] = {}
        for mesh, slots, members in _displaced(users):
            shape = self._shapes[id(scene.meshes[mesh]), slots]
            assert shape.displaced is not None
            if len(users[mesh]) == 1:
                meshes[mesh] = shape.displaced
                places[mesh] = [(mesh, shape)]
                continue
            places.setdefault(mesh, []).append((len(meshes), shape))
            for member in members:
                instances[member] = _placed(shape, instances[member], len(meshes))
            meshes.append(shape.displaced)
        result = dataclasses.replace(
            scene,
            meshes=meshes,
            instances=instances,
            shutter=_with_displaced(scene.shutter, places, users),
            neighbors=_with_displaced(scene.neighbors, places, users),
        )
        bent = [shutter.meshes for shutter in (scene.shutter, scene.neighbors) if shutter is not None]
        known = set(map(id, itertools.chain(scene.instances, *bent)))
        for shape in self._shapes.values():
            shape.keep(known)
        return result


_Users = dict[int, dict[_Slots, list[int]]]
"""By mesh and slots, the instances."""


def _users(scene: Scene, slots_of: dict[int, tuple[int, bool]]) -> _Users:
    """Return the instances of those meshes of which any instance is displaced, by mesh and slots."""
    if not slots_of:
        return {}
    found: _Users = {}
    known: dict[tuple[int, ...], _Slots] = {}
    for member, instance in enumerate(scene.instances):
        if scene.meshes[instance.mesh].shape is not MeshShape.SURFACE:  # as in Cycles
            continue
        key = tuple(instance.materials)
        if key not in known:
            known[key] = tuple(slots_of.get(material) for material in key)
        found.setdefault(instance.mesh, {}).setdefault(known[key], []).append(member)
    return {mesh: by_slots for mesh, by_slots in found.items() if any(map(any, by_slots))}


def _displaced(users: _Users) -> Iterator[tuple[int, _Slots, list[int]]]:
    for mesh, by_slots in users.items():
        for slots, members in by_slots.items():
            if any(slots):
                yield mesh, slots, members


def _placed(shape: _Shape, instance: Instance, mesh: int) -> Instance:
    """The instance with the displaced mesh in place of its own."""
    before, placed = shape.placed.get(id(instance), (None, None))
    if placed is None or before is not instance or placed.mesh != mesh:
        placed = dataclasses.replace(instance, mesh=mesh)
        shape.placed[id(instance)] = instance, placed
    return placed


def _moved(shape: _Shape, offsets: np.ndarray) -> Mesh:
    mesh = shape.mesh
    positions = mesh.positions + offsets
    attributes = dict(mesh.attributes)
    if any(slot is not None and slot[1] for slot in shape.slots):
        attributes[UNDISPLACED] = MeshAttribute(AttributeDomain.POINT, mesh.positions)
    normals = shape.normals(mesh.positions, positions, mesh.corner_normals)
    return dataclasses.replace(mesh, positions=positions, corner_normals=normals, attributes=attributes)


def _with_displaced(
    shutter: Shutter | None, places: dict[int, list[tuple[int, _Shape]]], users: _Users
) -> Shutter | None:
    """Return a shutter whose bending meshes are displaced, with the same offsets at all times, as in Cycles; the
    shutter itself where none of them is displaced."""
    if shutter is None or not any(deformation.mesh in places for deformation in shutter.meshes):
        return shutter
    meshes = []
    for deformation in shutter.meshes:
        shapes = places.get(deformation.mesh, [])
        if len(shapes) < len(users.get(deformation.mesh, {None: []})):  # somebody has the mesh as it was
            meshes.append(deformation)
        meshes += [_bent(shape, deformation, place) for place, shape in shapes]
    return dataclasses.replace(shutter, meshes=meshes)


def _bent(shape: _Shape, deformation: Deformation, place: int) -> Deformation:
    before, bent = shape.deformations.get(id(deformation), (None, None))
    if bent is None or before is not deformation or bent.mesh != place:
        whole = deformation if shape.diced is None else shape.diced.deformed(deformation)
        positions = whole.positions + shape.offsets
        keys = zip(whole.positions, positions, whole.corner_normals, strict=True)
        normals = np.stack([shape.normals(*key) for key in keys])
        bent = Deformation(place, deformation.times, positions, normals)
        shape.deformations[id(deformation)] = deformation, bent
    return bent
