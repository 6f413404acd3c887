# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that others multiply, as collections, particles, faces and geometry nodes do."""

from dataclasses import dataclass, field

import bpy
import numpy as np

from ..camera.culling import Selection
from ..view_layer.visibility import is_seen
from .converted_curves import ConvertedCurves
from .instance_description import InstanceDescription, Instancer
from .instance_groups import InstanceGroup, InstanceGroups
from .instance_reader import CONVERTED_TYPES, InstanceReader
from .particles import ParticleTable
from .placements import Identity, Placements, identity_of


@dataclass(slots=True)
class _Prototype:
    """An object and a mesh that others multiply. Its description is read with its first instance."""

    uid: int
    """session_uid of the object."""
    is_described: bool = False
    description: InstanceDescription | None = None
    """Description of the object by itself; None where nothing of it is rendered."""
    reads_instancer: bool = False
    """Whether its materials read attributes that instances may have of their own."""
    curve: int = 0
    """Address of the original object if the mesh is that of a curve or the like, or else 0."""
    owners: set[int] = field(default_factory=set)
    """session_uid of the objects that multiply it."""
    multiplied: dict[tuple, InstanceGroup] = field(default_factory=dict)
    """Groups of its instances, by what instancers pass on to them."""


class MultipliedObjects:
    """Places instances of objects that others multiply; the instances of a mesh share one description."""

    def __init__(
        self,
        reader: InstanceReader,
        placements: Placements,
        curves: ConvertedCurves,
        particles: ParticleTable,
        groups: InstanceGroups,
        may_have_hair: bool,
    ) -> None:
        """may_have_hair: whether objects may have hair, which arrays do not describe."""
        self._reader = reader
        self._placements = placements
        self._curves = curves
        self._particles = particles
        self._groups = groups
        self._may_have_hair = may_have_hair
        self._nothing = groups.open(None)
        self._instancers: dict[int, Instancer | None] = {}
        """Instancers by their addresses; None where the viewport does not show them."""
        self._prototypes: dict[tuple[int, int], _Prototype] = {}
        """Prototypes by the addresses of the object and its mesh."""

    def export(
        self,
        number: int,
        entry: bpy.types.DepsgraphObjectInstance,
        source: bpy.types.Object,
        matrix: np.ndarray,
        selection: Selection,
    ) -> None:
        """Place the object of an entry of a depsgraph, of a number, at a matrix (4, 4).

        Where arrays describe the instances that the entry's instancer has of the object, the groups take them. Raises
        Unfinished when the slice is over.
        """
        parent, data = entry.parent, source.data
        address = parent.as_pointer()
        if address not in self._instancers:
            self._instancers[address] = self._read_instancer(parent, selection)
        instancer = self._instancers[address]
        key = entry.instance_object.as_pointer(), 0 if data is None else data.as_pointer()
        prototype = self._prototypes.get(key)
        if prototype is None:
            prototype = self._prototypes[key] = self._begin_prototype(source)
        kind = source.type
        is_shown = instancer is not None and (is_seen(instancer.visibility) or kind == "LIGHT")
        if kind == "MESH" and self._may_group(source, selection) and (entry.show_self or not is_shown):
            group = self._group_of(prototype, entry, source, instancer) if is_shown else self._nothing
            if group is self._nothing or not prototype.curve:
                self._groups.assign((*key, address), number, entry, group)
                return
        if is_shown and entry.show_self and not selection.culling.leaves_out(source, matrix):
            self._place(prototype, entry, source, matrix, instancer)

    def _may_group(self, source: bpy.types.Object, selection: Selection) -> bool:
        """Return whether arrays may describe all that instances of a mesh object bring."""
        if self._placements.identify or selection.culling.is_used:
            return False
        return not (self._may_have_hair and len(source.particle_systems) > 0)

    def _place(
        self,
        prototype: _Prototype,
        entry: bpy.types.DepsgraphObjectInstance,
        source: bpy.types.Object,
        matrix: np.ndarray,
        instancer: Instancer,
    ) -> None:
        """Place the object of an entry by itself."""
        identity = identity_of(entry, source.original, entry.parent.original) if self._placements.identify else ()
        if source.type == "LIGHT":
            light = self._reader.light(source, matrix, instancer)
            if light is not None:
                self._placements.add_light(light, prototype.uid, identity)
        elif source.type == "MESH":
            description = self._group_of(prototype, entry, source, instancer).description
            if description is not None:
                self._place_mesh(prototype, description, entry, source, matrix, instancer, identity)
        else:
            self._place_other(entry, source, matrix, instancer, identity)

    def _read_instancer(self, parent: bpy.types.Object, selection: Selection) -> Instancer | None:
        original = parent.original
        uid = original.session_uid
        self._placements.mark_multiple(uid)
        self._reader.faceless.brings_others(uid)
        return self._reader.instancer(parent, uid) if selection.shows(original) else None

    def _begin_prototype(self, source: bpy.types.Object) -> _Prototype:
        uid = source.original.session_uid
        self._placements.mark_multiple(uid)
        self._reader.faceless.is_multiplied(uid)
        return _Prototype(uid)

    def _group_of(
        self,
        prototype: _Prototype,
        entry: bpy.types.DepsgraphObjectInstance,
        source: bpy.types.Object,
        instancer: Instancer,
    ) -> InstanceGroup:
        """The group of the instances of an entry's mesh, which is described when it is met first."""
        reader = self._reader
        if not prototype.is_described:
            description = prototype.description = reader.describe(source, entry)
            if description is not None:
                prototype.reads_instancer = reader.reads_instancer(description.materials)
                original = source.original
                prototype.curve = original.as_pointer() if original.type in CONVERTED_TYPES else 0
            prototype.is_described = True
        if prototype.description is None:
            return self._nothing
        if instancer.uid not in prototype.owners:
            reader.add_owner(prototype.description, instancer)
            prototype.owners.add(instancer.uid)
        # Instances that may have attributes of their own are found by what multiplies them.
        key = instancer if prototype.reads_instancer else instancer.passed_on
        if key not in prototype.multiplied:
            description = prototype.description.multiplied_by(instancer)
            prototype.multiplied[key] = self._groups.open(
                description,
                self._particles if instancer.has_particles else None,
                reader.attribute_notes(source, description.materials, entry) if prototype.reads_instancer else None,
            )
        return prototype.multiplied[key]

    def _place_mesh(
        self,
        prototype: _Prototype,
        description: InstanceDescription,
        entry: bpy.types.DepsgraphObjectInstance,
        source: bpy.types.Object,
        matrix: np.ndarray,
        instancer: Instancer,
        identity: Identity,
    ) -> None:
        """Place an instance by itself."""
        reader = self._reader
        if prototype.curve:
            self._curves.add_mesh(prototype.curve, matrix)
        instance = description.place(
            matrix,
            random_of(entry),
            self._particles.of(entry) if instancer.has_particles else None,
            reader.attribute_values(source, description.materials, entry) if prototype.reads_instancer else None,
        )
        if prototype.reads_instancer:
            reader.missing.note(instance)
        self._placements.add(instance, matrix, 0, identity)

    def _place_other(
        self,
        entry: bpy.types.DepsgraphObjectInstance,
        source: bpy.types.Object,
        matrix: np.ndarray,
        instancer: Instancer,
        identity: Identity,
    ) -> None:
        """Place what is no mesh yet, which each instance has of its own."""
        description = self._reader.describe(source, entry)
        if description is None or not is_seen(description.visibility & instancer.visibility):
            return
        description = description.multiplied_by(instancer)
        random, particle = random_of(entry), self._particles.of(entry)
        if source.type in CONVERTED_TYPES:
            self._curves.add(source, description, matrix, identity, random, particle)
            return
        original = source.original
        if original.type in CONVERTED_TYPES:
            self._curves.add_mesh(original.as_pointer(), matrix)
        self._placements.add(description.place(matrix, random, particle), matrix, 0, identity)


def random_of(entry: bpy.types.DepsgraphObjectInstance) -> float:
    """The random number of an instance that an object multiplies, 0 to 1."""
    return (entry.random_id & 0xFFFFFFFF) / 0xFFFFFFFF
