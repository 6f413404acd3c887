# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances that share a description, collected as arrays while a pass goes through the entries of a depsgraph."""

from collections.abc import Hashable, Iterable, Iterator

import bpy
import numpy as np

from ....scene import Instance, InstanceArray
from ..common.matrices import are_plain
from ..shading.nodes.missing_attributes import MissingAttributes
from .instance_attributes import AttributeNotes
from .instance_description import InstanceDescription
from .particles import ParticleRows, ParticleTable
from .placements import Placements

_LARGEST_RANDOM_ID = 0xFFFFFFFF


class InstanceGroup:
    """Instances of one description. Between two slices of a pass it holds nothing of Blender's."""

    def __init__(
        self,
        description: InstanceDescription | None,
        particles: ParticleTable | None = None,
        attributes: AttributeNotes | None = None,
    ) -> None:
        """description: None is of what is not rendered. particles: those that the instances may stand for. attributes:
        notes of the attributes that each may have of its own."""
        self.description = description
        self._numbers: list[int] = []
        self._random_ids: list[int] = []
        self._particles = None if particles is None else ParticleRows(particles)
        self._attributes = attributes
        self.arrays: list[InstanceArray] = []
        """Instances of the slices before, with the numbers of their entries as places."""

    def take(self, number: int, entry: bpy.types.DepsgraphObjectInstance) -> None:
        """Take the instance of an entry, by the entry's number."""
        if self.description is None:
            return
        self._numbers.append(number)
        self._random_ids.append(entry.random_id)
        if self._particles is not None:
            self._particles.add(entry)
        if self._attributes is not None:
            self._attributes.add(entry)

    def settle(self, matrices: np.ndarray, placements: Placements, missing: MissingAttributes) -> None:
        """Make an array of the instances that were taken since the last call.

        matrices: (entries, 4, 4) float32, object to world. Instances that arrays do not describe are placed one by one.
        missing: takes note of the attributes that instances lack.
        """
        if not self._numbers:
            return
        numbers = np.array(self._numbers, np.int32)
        randoms = (np.array(self._random_ids, np.int64) & _LARGEST_RANDOM_ID) / _LARGEST_RANDOM_ID
        self._numbers, self._random_ids = [], []
        fits = are_plain(matrices[numbers])
        is_particle, particles, attributes = np.zeros(len(numbers), bool), None, None
        if self._particles is not None:
            is_particle, particles = self._particles.end()
            fits &= is_particle
        if self._attributes is not None:
            attributes = self._attributes.end()
            fits &= attributes.are_whole(len(numbers))

        def instance(place: int) -> Instance:
            made = self.description.place(
                matrices[numbers[place]].astype(np.float64),
                float(randoms[place]),
                particles[place] if is_particle[place] else None,
                None if attributes is None else attributes[place],
            )
            if attributes is not None:
                missing.note(made)
            return made

        for place in np.flatnonzero(~fits).tolist():
            placements.begin_entry(int(numbers[place]))
            alone = instance(place)
            placements.add(alone, alone.matrix, 0, ())
        if fits.any():
            self.arrays.append(
                InstanceArray(
                    instance(int(fits.argmax())),
                    numbers[fits],
                    matrices[numbers[fits], :3],
                    randoms[fits],
                    None if particles is None else particles.rows(fits),
                    {} if attributes is None else attributes.columns(fits),
                )
            )

    def joined_arrays(self) -> list[InstanceArray]:
        """All instances of the group in as few arrays as may be."""
        alike: dict[Hashable, list[InstanceArray]] = {}
        for array in self.arrays:
            channels = sorted((name, values.shape[1]) for name, values in array.attributes.items())
            alike.setdefault((*channels, *sorted(array.first.attributes)), []).append(array)
        return [InstanceArray.joined(arrays) for arrays in alike.values()]


class InstanceGroups:
    """Groups of instances, by what Blender's entries show."""

    def __init__(self, placements: Placements, missing: MissingAttributes) -> None:
        self._placements = placements
        self._missing = missing
        self._groups: list[InstanceGroup] = []
        self._known: dict[tuple[int, int, int], InstanceGroup] = {}
        """Groups by the addresses of an object, of its data and of what multiplies it."""

    def open(
        self,
        description: InstanceDescription | None,
        particles: ParticleTable | None = None,
        attributes: AttributeNotes | None = None,
    ) -> InstanceGroup:
        """Begin a group. The arguments are those of InstanceGroup."""
        group = InstanceGroup(description, particles, attributes)
        self._groups.append(group)
        return group

    def assign(
        self, key: tuple[int, int, int], number: int, entry: bpy.types.DepsgraphObjectInstance, group: InstanceGroup
    ) -> None:
        """Take the instance of an entry into a group, and from now on all that have the key.

        key: addresses of the entry's object, of its data and of what multiplies it.
        """
        self._known[key] = group
        group.take(number, entry)

    def others(
        self, entries: Iterable[tuple[int, bpy.types.DepsgraphObjectInstance]]
    ) -> Iterator[tuple[int, bpy.types.DepsgraphObjectInstance]]:
        """Yield numbered entries that belong to no group; groups take the others."""
        known = self._known
        holder = data = parent = group = None
        for number, entry in entries:
            if not entry.is_instance:
                yield number, entry
                continue
            # Blender gives a data-block the same wrapper as long as that is in use.
            new_holder, new_data, new_parent = entry.instance_object, entry.object.data, entry.parent
            if group is None or new_holder is not holder or new_data is not data or new_parent is not parent:
                holder, data, parent = new_holder, new_data, new_parent
                address = 0 if data is None else data.as_pointer()
                group = known.get((holder.as_pointer(), address, parent.as_pointer()))
            if group is None:
                yield number, entry
            elif entry.show_self:
                group.take(number, entry)

    def settle(self, matrices: np.ndarray) -> None:
        """End a slice: make arrays of all that was taken. matrices: (entries, 4, 4) float32, object to world."""
        for group in self._groups:
            group.settle(matrices, self._placements, self._missing)

    def arrays(self) -> list[InstanceArray]:
        """The instances of all groups, with the numbers of their entries as places."""
        return [array for group in self._groups for array in group.joined_arrays()]
