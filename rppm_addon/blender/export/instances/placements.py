# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances and lights that a pass over a depsgraph places, and identities by which they are found again."""

import dataclasses
import operator
from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy
import numpy as np

from ....scene import Instance, InstanceArray, Light
from ..common.matrices import usable_matrices
from ..common.report import Report

_PARTS = {"CURVES": -2, "POINTCLOUD": -3}
"""Last number in the identity of the hair curves or points that one object shows beside its mesh, by object type."""
_HAIR = -1
"""Last number in the identity of the hair that an object's particle systems bring."""
_FEWEST = 32
"""Instances that an array has at least; arrays pay from about a dozen on."""

Identity = tuple[int, ...]
"""Key by which an instance or a light is found again at other times: the session_uid of its object, or those of what
multiplies the object and of the object, and Blender's persistent_id."""


def identity_of(
    instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, owner: bpy.types.Object
) -> Identity:
    """Return the identity of an instance. source: the original object; owner: what multiplies it, or itself."""
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
    """Instances that are in no array."""
    arrays: list[InstanceArray] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    single_instances: dict[int, int] = field(default_factory=dict)
    """Index of the only instance of each mesh object that multiplies nothing, by session_uid."""
    single_lights: dict[int, int] = field(default_factory=dict)
    """Index of the only light of each light object, by session_uid."""
    identities: dict[int, Identity] = field(default_factory=dict)
    """Identities of instances and lights, by their id(), if asked for."""


class Placements:
    """Collects the instances and lights of a pass, and leaves out instances whose matrices are not usable."""

    def __init__(self, identify: bool) -> None:
        """identify: whether identities are recorded."""
        self.identify = identify
        self._placed = Placed()
        self._number = 0
        """Number of the entry of the depsgraph whose instances are added."""
        self._unchecked: list[tuple[Instance, np.ndarray, int, int]] = []
        """Instances whose matrices were not looked at yet, with the matrices, the session_uid of single objects and the
        numbers of their entries."""
        self._checked: list[tuple[int, Instance, int]] = []
        """Numbers of entries, instances and the session_uid of single objects."""
        self._unusable: dict[str, int] = {}
        """Numbers of placements that were left out, by object name."""
        self._multiple: set[int] = set()
        """session_uid of objects with several instances, or that multiply others."""

    def begin_entry(self, number: int) -> None:
        """Begin to add the instances of an entry, by its number. Instances are placed in the order of the numbers."""
        self._number = number

    def add(self, instance: Instance, matrix: np.ndarray, uid: int, identity: Identity) -> None:
        """Take an instance at a matrix (4, 4). uid: the session_uid of a single object; 0 for other instances."""
        if self.identify:
            self._placed.identities[id(instance)] = identity
        self._unchecked.append((instance, matrix, uid, self._number))

    def add_light(self, light: Light, uid: int, identity: Identity) -> None:
        """Take a light. uid: the session_uid of its object."""
        if self.identify:
            self._placed.identities[id(light)] = identity
        self._placed.single_lights[uid] = len(self._placed.lights)
        self._placed.lights.append(light)

    def mark_multiple(self, uid: int) -> None:
        """Record that an object, by its session_uid, has several instances or multiplies others."""
        self._multiple.add(uid)

    def check(self) -> None:
        """Look at the matrices of the instances that were added since the last call."""
        if not self._unchecked:
            return
        given = np.array([matrix for _, matrix, _, _ in self._unchecked])
        matrices, usable = usable_matrices(given)
        mended = (matrices != given).any(axis=(1, 2)).tolist()
        for place, ((instance, _, uid, number), good) in enumerate(zip(self._unchecked, usable.tolist(), strict=True)):
            if good:
                if mended[place]:
                    instance.matrix = matrices[place]
                self._checked.append((number, instance, uid))
            else:
                self._unusable[instance.object_name] = self._unusable.get(instance.object_name, 0) + 1
        self._unchecked = []

    def finish(self, report: Report, arrays: Sequence[InstanceArray] = ()) -> Placed:
        """Return the result after the last check, and warn of placements that were left out.

        arrays: further instances, whose places are the numbers of their entries.
        """
        for name, count in self._unusable.items():
            report.warn(
                f'Object "{name}": {count} placements have no extent (scale 0) or are not finite and were left out; '
                "give them a scale"
            )
        self._arrange(arrays)
        placed, multiple = self._placed, self._multiple | {0}
        placed.single_instances = _without(placed.single_instances, multiple)
        placed.single_lights = _without(placed.single_lights, multiple)
        return placed

    def _arrange(self, arrays: Sequence[InstanceArray]) -> None:
        """Give instances their places, in the order of the numbers of their entries."""
        few = [array for array in arrays if len(array) < _FEWEST]
        many = [array for array in arrays if len(array) >= _FEWEST]
        for array in few:
            self._checked += zip(array.places.tolist(), array.instances(), [0] * len(array), strict=True)
        placed = self._placed
        self._checked.sort(key=operator.itemgetter(0))
        placed.instances = [instance for _, instance, _ in self._checked]
        placed.single_instances = {uid: place for place, (_, _, uid) in enumerate(self._checked)}
        if not many:
            return
        single = np.array([number for number, _, _ in self._checked], np.int64)
        numbers = np.concatenate([single, *(array.places for array in many)])
        places = np.empty(len(numbers), np.int32)
        places[np.argsort(numbers, kind="stable")] = np.arange(len(numbers), dtype=np.int32)
        ends = np.cumsum([len(single), *map(len, many)])
        placed.arrays = [
            dataclasses.replace(array, places=places[end - len(array) : end])
            for array, end in zip(many, ends[1:].tolist(), strict=True)
        ]


def _without(places: dict[int, int], keys: set[int]) -> dict[int, int]:
    return {key: place for key, place in places.items() if key not in keys}
