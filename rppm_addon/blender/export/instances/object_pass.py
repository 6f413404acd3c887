# SPDX-License-Identifier: GPL-3.0-or-later
"""One pass over the instances of a depsgraph."""

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np

from ....scene import Instance, Light, RayVisibility
from ....scene.meshes import SMOOTH_NORMALS
from ..common.matrices import usable_matrices
from ..geometry.meshes.attributes import GENERATED, ISLAND, POINTINESS, TANGENT, title_of
from ..geometry.meshes.rendered_meshes import has_no_faces, is_gas_domain
from ..geometry.strands.attributes import OF_ROUND_SHAPES
from ..geometry.strands.particle_hair import HAIRLESS_MODES, hair_modifiers, hair_systems
from ..geometry.strands.round_meshes import ROUND_TYPES, Hair, RoundSource
from ..omissions import objects_of
from ..view_layer.visibility import visibility_of
from .faceless import FacelessObjects
from .instance_reader import InstanceReader, shaded_instance
from .object_matrices import instance_matrices
from .particles import ParticleTable

_AT_ONCE = 32
"""Instances between which nobody looks at the clock."""
CONVERTED_TYPES = {"CURVE", "FONT", "META", "SURFACE"}
"""Object types that are rendered as the mesh that Blender makes of them."""
SURFACE_TYPES = {"MESH", *CONVERTED_TYPES, *ROUND_TYPES}
"""Object types that are rendered as surfaces."""
UNSUPPORTED_TYPES = {"VOLUME": "volumes"}

_PARTS = {"CURVES": -2, "POINTCLOUD": -3}
"""Last number in the identity of the hair curves or points that one object shows beside its mesh, by object type."""
_HAIR = -1
"""Likewise, what its particle systems bring."""

Identity = tuple[int, ...]
"""By what an instance or a light is known at other times: the session_uid of its object, or those of what multiplies
the object and of the object, and Blender's persistent_id."""


def identity_of(
    instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, owner: bpy.types.Object
) -> Identity:
    """source: the original object; owner: what multiplies it, or itself."""
    part = _PARTS.get(instance.object.type)
    if part is not None:
        return (owner.session_uid, source.session_uid, *instance.persistent_id, part)
    if not instance.is_instance:
        return (owner.session_uid,)
    return (owner.session_uid, source.session_uid, *instance.persistent_id)


def identity_of_hair(identity: Identity, source: bpy.types.Object) -> Identity:
    """Return the identity of the hair that an instance's object has by its particle systems.

    identity: that of the instance; source: the original object.
    """
    return (*(identity if len(identity) > 1 else (*identity, source.session_uid)), _HAIR)


@dataclass
class Placed:
    """Instances and lights that a pass over a depsgraph found."""

    instances: list[Instance] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    alone: dict[int, int] = field(default_factory=dict)
    """By session_uid, the index of the only instance of each mesh object that multiplies nothing."""
    lights_alone: dict[int, int] = field(default_factory=dict)
    """By session_uid, the index of the only light of each light object."""
    identities: dict[int, Identity] = field(default_factory=dict)
    """Identities of instances and lights, by their id(), if asked for."""


@dataclass(slots=True)
class _Kind:
    """Data that the instances of one object and mesh have in common; where the mesh is None, none is rendered."""

    uid: int
    learned: bool = False
    """Whether the rest is known, for which its mesh and materials had to be exported."""
    mesh: int | None = None
    converted: int = 0
    """The address of the original object if it is a curve or the like, or else 0."""
    name: str = ""
    object_index: int = 0
    shading: dict[str, object] = field(default_factory=dict)
    asks_instancer: bool = False
    placed: bool = False
    """Whether there is such an instance."""


@dataclass(slots=True)
class _Owner:
    """Object that multiplies others."""

    uid: int
    shown: bool
    visibility: RayVisibility
    """Visibility of the objects that it multiplies, combined with the visibility of each object itself."""
    holdout: bool
    """Holdout flag of the objects that the owner multiplies, in place of their own flags, as in Cycles."""
    shadow_catcher: bool
    has_particles: bool


class ObjectPass:
    """One pass over the instances of a depsgraph. Between two slices of it nothing of Blender is held."""

    def __init__(
        self,
        reader: InstanceReader,
        unchanged: dict[int, Instance],
        moved: dict[int, Instance],
        identify: bool,
    ) -> None:
        self._identify = identify
        self._reader = reader
        self._report = reader.report
        self._shown: Callable[[bpy.types.Object], bool] | None = None
        self._begin(unchanged, moved)

    def _begin(self, unchanged: dict[int, Instance], moved: dict[int, Instance]) -> None:
        self._identity: Identity = ()
        """Identity of the instance or light that is being placed."""
        self.place = 0
        """How many instances have been dealt with."""
        self.count = 0
        """How many there are, once the pass goes on."""
        self._is_placed = False
        """Whether only the hair of the next one is to be dealt with."""
        self._particles = ParticleTable()
        self._matrices: np.ndarray | None = None
        self._unchanged = unchanged
        self._moved = moved
        self._placed: list[tuple[Instance, np.ndarray, int]] = []
        self._unconverted: list[tuple[tuple[int, int], np.ndarray, dict[str, object], Identity]] = []
        """By session_uid and address of an original object."""
        self._lost: dict[str, int] = {}
        self._converted: set[tuple[int, bytes]] = set()
        self._missing: dict[tuple[str, str, str], dict[str, None]] = {}
        """By names of material, node and attribute, the objects that do not have it."""
        self._lacks_nothing: set[tuple] = set()
        """Keys of instances that have all attributes that their materials read. A key holds the mesh, the number of the
        mesh's attributes, the materials, and the names of the instance's own attributes."""
        self._kinds: dict[tuple[int, int], _Kind] = {}
        """By the addresses of the object and its mesh."""
        self._owners: dict[int, _Owner] = {}
        """By their addresses."""
        self._multiple: set[int] = set()
        """Objects that are multiplied or multiply others."""
        self._faceless = FacelessObjects()
        self._sampled = self._reader.materials.sampled
        self._result = Placed()

    def go_on(self, depsgraph: bpy.types.Depsgraph, shown: Callable[[bpy.types.Object], bool] | None) -> Placed:
        """All instances and lights, of a depsgraph that is as it was when the pass began.

        shown: which of the original objects are to be seen, all if None. Raises Unfinished when the slice is over, to
        be called again, and ExportStopped when the user wants no more.
        """
        self._shown, self._reader.instance_attributes.depsgraph = shown, depsgraph
        try:
            self._export_all(depsgraph)
            self._convert(depsgraph)
            if self._sampled != self._reader.materials.sampled:  # meshes that came before were not asked for it
                self._begin({}, {})
                self._export_all(depsgraph)
                self._convert(depsgraph)
        finally:
            self._shown = self._reader.instance_attributes.depsgraph = None  # they may hold something of Blender's
            self._particles.forget()
            self._keep_usable()
        self._tell_lost()
        self._tell_missing()
        self._faceless.tell(self._report)
        self._result.alone = _without(self._result.alone, self._multiple | {0})
        self._result.lights_alone = _without(self._result.lights_alone, self._multiple)
        return self._result

    def _export_all(self, depsgraph: bpy.types.Depsgraph) -> None:
        if self._matrices is None:
            self._matrices = instance_matrices(depsgraph)
            self.count = len(self._matrices)
        if self.place == self.count:
            return
        start, slices, matrices = self.place, self._report.slices, self._matrices
        self._particles.frame = depsgraph.scene_eval.frame_current_final
        has_hair = self._reader.may_have_hair
        for number, instance in enumerate(depsgraph.object_instances):
            if number < start:  # Blender's iterator is nothing to be held from one slice to the next
                continue
            if number == start:
                slices.restart()
            if number % _AT_ONCE == 0 and number > start:
                slices.rest()
                self._report.progress(f"Exporting objects ({number})")
            # Only valid inside the loop: Blender reuses the memory for the next instance.
            source = instance.object
            if self._reader.use_surfaces or source.type == "LIGHT":
                if not self._is_placed:
                    if instance.is_instance:
                        self._export_multiplied(instance, source, matrices[number])
                    elif instance.show_self:
                        self._export_alone(instance, source, matrices[number])
                if has_hair and source.type == "MESH" and instance.show_particles:
                    self._is_placed = True
                    self._export_hair(instance, source, matrices[number])
            self.place, self._is_placed = number + 1, False
        self.place = self.count

    def _export_alone(
        self, instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, matrix: np.ndarray
    ) -> None:
        original = source.original
        if not (self._shown is None or self._shown(original)) or self._reader.culling.leaves_out(source, matrix):
            return
        uid = original.session_uid
        if self._identify:
            self._identity = identity_of(instance, original, original)
        if source.type in ROUND_TYPES:  # an object may show several
            self._multiple.add(uid)
            self._faceless.brings_others(uid)
            self._export_instance(source, matrix, uid)
            return
        meshes, kept = self._reader.meshes, self._unchanged.get(uid)
        if kept is None and (moved := self._moved.get(uid)) is not None and meshes.knows(moved.mesh):
            kept = self._reader.instance(source, matrix, moved)
            if kept is None:
                return
        if kept is None or not meshes.knows(kept.mesh):
            self._export_instance(source, matrix, uid)
        else:
            meshes.keep(kept.mesh)
            self._note_missing(kept)
            self._add(kept, matrix, uid)

    def _export_multiplied(
        self, instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, matrix: np.ndarray
    ) -> None:
        parent = instance.parent
        owner = self._owners.get(parent.as_pointer())
        if owner is None:
            original = parent.original
            shown = self._shown is None or self._shown(original)
            has_particles = len(parent.particle_systems) > 0
            owner = _Owner(
                original.session_uid,
                shown,
                visibility_of(parent),
                parent.is_holdout,
                parent.is_shadow_catcher,
                has_particles,
            )
            self._owners[parent.as_pointer()] = owner
            self._multiple.add(owner.uid)
            self._faceless.brings_others(owner.uid)
        data = source.data
        key = instance.instance_object.as_pointer(), 0 if data is None else data.as_pointer()
        kind = self._kinds.get(key)
        if kind is None:
            kind = self._kinds[key] = _Kind(source.original.session_uid)
            self._multiple.add(kind.uid)
            self._faceless.is_multiplied(kind.uid)
        if not (owner.shown and instance.show_self) or not (owner.visibility or source.type == "LIGHT"):
            return
        if self._reader.culling.leaves_out(source, matrix):
            return
        if self._identify:
            self._identity = identity_of(instance, source.original, parent.original)
        if source.type != "MESH":
            self._export_instance(source, matrix, owner.uid, instance, parent)
            return
        if not kind.learned:
            self._learn(kind, source, owner, instance)
        if kind.mesh is None:
            return
        self._reader.meshes.add_owner(kind.mesh, owner.uid)
        if kind.converted:
            self._converted.add((kind.converted, matrix.tobytes()))
        shading = kind.shading
        # Another one may multiply it that is in other collections.
        own = visibility_of(source) & owner.visibility
        visibility, holdout = self._reader.masked(parent, own, owner.holdout)
        placed = Instance(
            kind.mesh,
            matrix,
            shading["materials"],
            kind.name,
            kind.object_index,
            tuple(source.color),
            _random_of(instance),
            self._particles.of(instance) if owner.has_particles else None,
            visibility,
            holdout,
            source.is_shadow_catcher or owner.shadow_catcher,
            shading["attributes"],
            self._reader.light_group(source, parent),
            self._reader.linking(parent),
            shading["terminator_geometry_offset"],
            shading["terminator_shading_offset"],
        )
        if kind.asks_instancer:
            placed.attributes = self._reader.attribute_values(source, placed.materials, instance)
        if kind.asks_instancer or not kind.placed:
            self._note_missing(placed)
            kind.placed = True
        self._add(placed, matrix, kind.uid)

    def _export_hair(
        self, instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, matrix: np.ndarray
    ) -> None:
        """Export the hair of an object's particle systems, whether the object itself is seen or not."""
        if len(source.particle_systems) == 0:
            return
        if instance.is_instance and instance.instance_object.data != source.data:
            return  # what its nodes of geometry multiply: as in Cycles, without hair
        instancer = instance.parent if instance.is_instance else None
        owner = (instancer or source).original
        if not (self._shown is None or self._shown(owner)) or self._reader.culling.leaves_out(source, matrix):
            return
        visibility = visibility_of(source)
        if instancer is not None:
            visibility &= visibility_of(instancer)
        systems = list(hair_systems(source, self._reader.is_render)) if visibility else []
        if source.mode in HAIRLESS_MODES and visibility and any(hair_modifiers(source, self._reader.is_render)):
            self._report.warn(
                f'Object "{source.name}": as in Cycles its hair is not rendered in {HAIRLESS_MODES[source.mode]}; '
                "leave that mode"
            )
        if not systems:
            return
        self._multiple.add(source.original.session_uid)
        self._faceless.brings_others(source.original.session_uid)
        if self._identify:
            self._identity = identity_of_hair(identity_of(instance, source.original, owner), source.original)
        shading = self._reader.shading(source, visibility, None if instancer is None else instance)
        if instancer is not None:
            shading |= {"random": _random_of(instance)}
        hair = Hair(source, systems, self._reader.uses_uv(shading["materials"]))
        self._place(source, hair, matrix, shading, owner.session_uid)

    def _learn(
        self, kind: _Kind, source: bpy.types.Object, owner: _Owner, instance: bpy.types.DepsgraphObjectInstance
    ) -> None:
        visibility = visibility_of(source)
        holder = instance.instance_object
        is_own = holder.data == source.data
        if not visibility or self._shows_no_mesh(source, is_own):
            kind.learned = True
            return
        kind.shading = self._reader.shading(source, visibility, instance)
        wanted, _ = self._reader.wanted_attributes(kind.shading["materials"])
        kind.asks_instancer = any(name.startswith("INSTANCER:") for name in wanted)
        original = source.original
        kind.converted = original.as_pointer() if original.type in CONVERTED_TYPES else 0
        kind.name, kind.object_index = source.name, source.pass_index
        kind.mesh = self._reader.mesh_index(holder, source.data, kind.shading, owner.uid)
        if kind.mesh is None and is_own:
            self._faceless.note(source)
        kind.learned = True

    def _shows_no_mesh(self, source: bpy.types.Object, is_own: bool) -> bool:
        """True where nothing of a mesh is rendered. is_own: it is the object's, none that nodes of geometry made."""
        if is_own and is_gas_domain(source):
            self._report.warn(
                f'Object "{source.name}": smoke and fire of fluid domains are not rendered yet; as in Cycles the '
                "domain's mesh is not shown"
            )
            return True
        if not has_no_faces(source.data):
            return False
        if is_own:
            self._faceless.note(source)
        return True

    def _add(self, instance: Instance, matrix: np.ndarray, uid: int) -> None:
        """uid: of an object that stands for itself, or is multiplied; 0 where it does not tell the instance."""
        if self._identify:
            self._result.identities[id(instance)] = self._identity
        self._placed.append((instance, matrix, uid))

    def _export_instance(
        self,
        source: bpy.types.Object,
        matrix: np.ndarray,
        owner: int,
        instance: bpy.types.DepsgraphObjectInstance | None = None,
        instancer: bpy.types.Object | None = None,
    ) -> None:
        """owner: the session_uid of what brings it. instance, instancer: of what is multiplied."""
        kind = source.type
        if kind == "LIGHT":
            light = self._reader.light(source, matrix, instancer)
            if light is not None:
                self._result.lights_alone[source.original.session_uid] = len(self._result.lights)
                self._result.lights.append(light)
                if self._identify:
                    self._result.identities[id(light)] = self._identity
            return
        if kind in UNSUPPORTED_TYPES:
            what = UNSUPPORTED_TYPES[kind]
            self._report.warn(f'Object "{source.name}": {what} are not rendered yet; it is left out')
            return
        if kind not in SURFACE_TYPES:
            return
        if kind == "CURVES" and not self._reader.shows_strands:
            return
        visibility = visibility_of(source)
        if instancer is not None:
            visibility &= visibility_of(instancer)
        if not visibility:
            return
        if kind == "MESH" and self._shows_no_mesh(source, True):
            return  # and its materials are not needed
        shading = self._reader.shading(source, visibility, instance)
        if instance is not None:
            shading |= {"random": _random_of(instance), "particle": self._particles.of(instance)}
        if kind in CONVERTED_TYPES:
            original = source.original
            self._unconverted.append(((original.session_uid, original.as_pointer()), matrix, shading, self._identity))
            return
        original = source.original
        if original.type in CONVERTED_TYPES:
            self._converted.add((original.as_pointer(), matrix.tobytes()))
        self._place(source, source.data, matrix, shading, owner)

    def _place(
        self,
        source: bpy.types.Object,
        mesh: bpy.types.Mesh | RoundSource | None,
        matrix: np.ndarray,
        shading: dict[str, object],
        owner: int,
    ) -> None:
        index = self._reader.mesh_index(source, mesh, shading, owner)
        if index is not None:
            if mesh is not None and not isinstance(mesh, bpy.types.Mesh):
                self._reader.materials.put_on_round_shapes(shading["materials"])
            uid = source.original.session_uid if isinstance(mesh, bpy.types.Mesh) else 0
            instance = shaded_instance(index, source, matrix, shading)
            self._note_missing(instance)
            self._add(instance, matrix, uid)
        elif isinstance(mesh, bpy.types.Mesh):
            self._faceless.note(source)

    def _note_missing(self, instance: Instance) -> None:
        """Attributes that the materials of an instance read and that it does not have."""
        materials, mesh = self._reader.materials, self._reader.meshes.meshes[instance.mesh]
        key = instance.mesh, len(mesh.attributes), tuple(instance.materials), tuple(instance.attributes)
        if key in self._lacks_nothing:
            return
        known = {GENERATED, ISLAND, POINTINESS, SMOOTH_NORMALS, TANGENT, *OF_ROUND_SHAPES}
        known |= {*mesh.attributes, *instance.attributes}
        asked = [(slot, materials.attributes[material]) for slot, material in enumerate(instance.materials)]
        if all(attributes.keys() <= known for _, attributes in asked):
            self._lacks_nothing.add(key)
            return
        slots = np.flatnonzero(np.bincount(np.minimum(mesh.triangle_slots, len(asked) - 1)))
        for slot, attributes in asked:
            for attribute in attributes.keys() - known if slot in slots else ():
                material = materials.materials[instance.materials[slot]].name
                objects = self._missing.setdefault((material, attributes[attribute], attribute), {})
                objects[instance.object_name] = None

    def _tell_missing(self) -> None:
        for (material, node, attribute), objects in sorted(self._missing.items()):
            first = next(iter(objects))
            lack = f'object "{first}" lacks' if len(objects) == 1 else f'{len(objects)} objects lack, such as "{first}"'
            self._report.warn(
                f'Material "{material}": node "{node}" reads {title_of(attribute)}, which {lack}; it counts as 0'
            )

    def _convert(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Place the curves, texts, surfaces and metaballs whose mesh did not come as an instance.

        Blender shows the mesh of such an object as an instance beside it, but not where particles
        or faces multiply the object.
        """
        if not self._unconverted:
            return
        sources = {source.original.as_pointer(): source for source in objects_of(depsgraph)}
        while self._unconverted:
            (uid, address), matrix, shading, self._identity = self._unconverted[0]
            if (address, matrix.tobytes()) not in self._converted:
                self._place(sources[address], None, matrix, shading, uid)
            del self._unconverted[0]
            self._report.slices.rest()

    def _keep_usable(self) -> None:
        """Add the instances that were placed since the last call to the result, except those with unusable matrices."""
        if not self._placed:
            return
        given = np.array([matrix for _, matrix, _ in self._placed])
        matrices, usable = usable_matrices(given)
        mended = (matrices != given).any(axis=(1, 2)).tolist()
        for number, ((instance, _, uid), good) in enumerate(zip(self._placed, usable.tolist(), strict=True)):
            if good:
                if mended[number]:
                    instance.matrix = matrices[number]
                self._result.alone[uid] = len(self._result.instances)
                self._result.instances.append(instance)
            else:
                self._lost[instance.object_name] = self._lost.get(instance.object_name, 0) + 1
        self._placed = []

    def _tell_lost(self) -> None:
        for name, count in self._lost.items():
            self._report.warn(
                f'Object "{name}": {count} placements have no extent (scale 0) or are not finite and were left out; '
                "give them a scale"
            )


def _without(places: dict[int, int], keys: set[int]) -> dict[int, int]:
    return {key: place for key, place in places.items() if key not in keys}


def _random_of(instance: bpy.types.DepsgraphObjectInstance) -> float:
    """From 0 to 1, for what is multiplied."""
    return (instance.random_id & 0xFFFFFFFF) / 0xFFFFFFFF
