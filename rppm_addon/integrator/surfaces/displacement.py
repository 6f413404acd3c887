# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are divided, and whose vertices are moved by what the nodes of their materials give there, as Cycles does
before a render."""

import dataclasses
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
from .dicing.diced_mesh import MOST_TRIANGLES, DicedMesh
from .displaced_normals import displaced_normals
from .displaced_vertices import DisplacedVertices

_Slots = tuple[tuple[int, bool] | None, ...]
"""Displacing material of each slot: its index, and whether it is bumped as well; None where the slot has none."""


@dataclass
class _Shape:
    """A mesh that is divided or has displacing materials, and what became of it."""

    source: Mesh
    slots: _Slots
    instance: Instance
    """The first that has it: of this one nodes are asked, whatever the others are."""
    diced: DicedMesh | None = None
    """The source divided; None where it stays whole."""
    dicing_key: tuple[object, ...] = ()
    """View and instances by which it was divided, to be compared."""
    offsets: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), np.float32))
    """(vertices, 3) object space; none where nothing displaces it."""
    displaced: Mesh | None = None
    deformations: dict[int, tuple[Deformation, Deformation]] = field(default_factory=dict)
    """By the id of a deformation, it and that of the displaced mesh."""
    placed: dict[int, tuple[Instance, Instance]] = field(default_factory=dict)
    """By the id of an instance, it and the same of the displaced mesh, where others have the mesh as it was."""

    @property
    def is_displaced(self) -> bool:
        """True where any of its materials displaces."""
        return any(self.slots)

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
        for mesh, slots, members in _changed(scene, users):
            source, first = scene.meshes[mesh], scene.instances[members[0]]
            key, shape = _dicing_key(scene, source, members), known.get((id(source), slots))
            if shape is None or shape.dicing_key != key:
                shape = _Shape(source, slots, first, _diced(scene, source, members), key)
            if renewed or shape.displaced is None or shape.instance is not first:
                shape.instance = first
                stale.append(shape)
            self._shapes[id(source), slots] = shape
            self._warn_of_coarsening(shape)
        if not self._shapes:
            return scene
        self._evaluate(scene, materials, stale)
        return self._with_shapes(scene, users)

    def as_known(self, scene: Scene) -> Scene:
        """The scene with those of its meshes displaced that the last one had; itself where there are none."""
        users = _users(scene, self._slots)
        changed = _changed(scene, users)
        unknown = {mesh for mesh, slots, _ in changed if (id(scene.meshes[mesh]), slots) not in self._shapes}
        users = {mesh: by_slots for mesh, by_slots in users.items() if mesh not in unknown}
        return self._with_shapes(scene, users) if users else scene

    def _evaluate(self, scene: Scene, materials: MaterialTables, shapes: list[_Shape]) -> None:
        for shape in shapes:
            if not shape.is_displaced:
                shape.displaced = shape.mesh
        shapes = [shape for shape in shapes if shape.is_displaced]
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

    def _warn_of_coarsening(self, shape: _Shape) -> None:
        if shape.diced is not None and shape.diced.coarsening > 1.0:
            self.warnings.append(
                f'Object "{shape.instance.object_name}": Adaptive Subdivision leaves edges '
                f"{shape.diced.coarsening:.1f} times as long as it is asked for, as it makes no more than "
                f"{MOST_TRIANGLES} triangles; raise its Pixel Size or the Dicing Rate"
            )

    def _with_shapes(self, scene: Scene, users: "_Users") -> Scene:
        meshes, instances = list(scene.meshes), list(scene.instances)
        places: dict[int, list[tuple[int, _Shape]]] = {}
        for mesh, slots, members in _changed(scene, users):
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
    """Return the instances of those meshes of which any instance is divided or displaced, by mesh and slots."""
    is_diced = [_is_smoothed(scene, mesh) for mesh in scene.meshes]
    if not slots_of and not any(is_diced):
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
    return {mesh: by_slots for mesh, by_slots in found.items() if is_diced[mesh] or any(map(any, by_slots))}


def _changed(scene: Scene, users: _Users) -> Iterator[tuple[int, _Slots, list[int]]]:
    """The meshes, slots and instances that are divided or displaced."""
    for mesh, by_slots in users.items():
        for slots, members in by_slots.items():
            if any(slots) or _is_smoothed(scene, scene.meshes[mesh]):
                yield mesh, slots, members


def _is_diced(scene: Scene, mesh: Mesh) -> bool:
    """True for a mesh that is divided where it is displaced. Texels know triangles by number."""
    return mesh.dicing is not None and mesh.triangle_count > 0 and scene.camera.texels is None


def _is_smoothed(scene: Scene, mesh: Mesh) -> bool:
    """True for a mesh that is divided even where nothing displaces it, as its faces bend."""
    return _is_diced(scene, mesh) and mesh.dicing is not None and mesh.dicing.is_curved


def _diced(scene: Scene, mesh: Mesh, members: list[int]) -> DicedMesh | None:
    """The mesh divided as these instances are seen; None where it stays whole."""
    if not _is_diced(scene, mesh):
        return None
    view = scene.dicing_view
    return DicedMesh(mesh, [scene.instances[member] for member in members], view.camera or scene.camera, view)


def _dicing_key(scene: Scene, mesh: Mesh, members: list[int]) -> tuple[object, ...]:
    """Return what the division of a mesh rests on beside the mesh, to be compared."""
    if mesh.dicing is None or not _is_diced(scene, mesh):
        return ()
    view = scene.dicing_view
    if not mesh.dicing.in_pixels:
        return view.max_subdivisions, view.rate, len(members)
    camera = view.camera or scene.camera
    seen = camera.matrix.tobytes(), camera.window, camera.width, camera.orthographic, repr(camera.panorama)
    places = [scene.instances[member].matrix for member in members]
    return view.max_subdivisions, view.rate, view.offscreen_scale, *seen, b"".join(place.tobytes() for place in places)


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
        positions, normals = whole.positions, whole.corner_normals
        if shape.is_displaced:
            positions = whole.positions + shape.offsets
            keys = zip(whole.positions, positions, whole.corner_normals, strict=True)
            normals = np.stack([shape.normals(*key) for key in keys])
        bent = Deformation(place, deformation.times, positions, normals)
        shape.deformations[id(deformation)] = deformation, bent
    return bent
