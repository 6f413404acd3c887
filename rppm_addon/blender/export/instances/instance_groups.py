# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances that share a description, collected as arrays while a pass goes through the entries of a depsgraph."""

from collections.abc import Iterable, Iterator

import bpy
import numpy as np

from ....scene import InstanceArray, Particle, ParticleArray
from ..common.matrices import are_plain
from .instance_description import InstanceDescription
from .particles import ParticleRows, ParticleTable
from .placements import Placements

_LARGEST_RANDOM_ID = 0xFFFFFFFF


class InstanceGroup:
    """Instances of one description. Between two slices of a pass it holds nothing of Blender's."""

    def __init__(self, description: InstanceDescription | None, particles: ParticleTable | None = None) -> None:
        """description: None is of what is not rendered. particles: those that the instances may stand for."""
        self.description = description
        self._numbers: list[int] = []
        self._random_ids: list[int] = []
        self._particles = None if particles is None else ParticleRows(particles)
        self._arrays: list[InstanceArray] = []
        """Instances of the slices before, with the numbers of their entries as places."""

    def take(self, number: int, entry: bpy.types.DepsgraphObjectInstance) -> None:
        """Take the instance of an entry, by the entry's number."""
        if self.description is None:
            return
        self._numbers.append(number)
        self._random_ids.append(entry.random_id)
        if self._particles is not None:
            self._particles.add(entry)

    def settle(self, matrices: np.ndarray, placements: Placements) -> None:
        """Make an array of the instances that were taken since the last call.

        matrices: (entries, 4, 4) float32, object to world. Instances that arrays do not describe are placed one by one.
        """
        if not self._numbers:
            return
        numbers = np.array(self._numbers, np.int32)
        randoms = (np.array(self._random_ids, np.int64) & _LARGEST_RANDOM_ID) / _LARGEST_RANDOM_ID
        self._numbers, self._random_ids = [], []
        found, particles = (None, None) if self._particles is None else self._particles.end()
        fits = are_plain(matrices[numbers])
        if found is not None:
            fits &= found
        for place in np.flatnonzero(~fits).tolist():
            is_particle = found is not None and found[place]
            self._place(placements, numbers[place], matrices, randoms[place], particles[place] if is_particle else None)
        if fits.any():
            numbers, randoms = numbers[fits], randoms[fits]
            particles = None if particles is None else particles.rows(fits)
            matrix = matrices[numbers[0]].astype(np.float64)
            first = self.description.place(matrix, float(randoms[0]), None if particles is None else particles[0])
            self._arrays.append(InstanceArray(first, numbers, matrices[numbers, :3], randoms, particles))

    def _place(
        self, placements: Placements, number: int, matrices: np.ndarray, random: float, particle: Particle | None
    ) -> None:
        """Place the instance of the entry of a number by itself."""
        matrix = matrices[number].astype(np.float64)
        placements.begin_entry(int(number))
        placements.add(self.description.place(matrix, float(random), particle), matrix, 0, ())

    def array(self) -> InstanceArray | None:
        """All instances of the group, with the numbers of their entries as places; None without any."""
        arrays = self._arrays
        if len(arrays) < 2:
            return arrays[0] if arrays else None
        return InstanceArray(
            arrays[0].first,
            np.concatenate([array.places for array in arrays]),
            np.concatenate([array.matrices for array in arrays]),
            np.concatenate([array.randoms for array in arrays]),
            None if self._particles is None else ParticleArray.joined([array.particles for array in arrays]),
        )


class InstanceGroups:
    """Groups of instances, by what Blender's entries show."""

    def __init__(self, placements: Placements) -> None:
        self._placements = placements
        self._groups: list[InstanceGroup] = []
        self._known: dict[tuple[int, int, int], InstanceGroup] = {}
        """Groups by the addresses of an object, of its data and of what multiplies it."""

    def open(self, description: InstanceDescription | None, particles: ParticleTable | None = None) -> InstanceGroup:
        """Begin a group. The arguments are those of InstanceGroup."""
        group = InstanceGroup(description, particles)
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
            group.settle(matrices, self._placements)

    def arrays(self) -> list[InstanceArray]:
        """The instances of all groups, with the numbers of their entries as places."""
        return [array for group in self._groups if (array := group.array()) is not None]
