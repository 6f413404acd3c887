# SPDX-License-Identifier: GPL-3.0-or-later
"""Columns of what the instances of a scene say: a million are read one by one once, and then as arrays."""

import operator
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from ...scene.light_linking import LightLinking
from ...scene.meshes import Instance, RayVisibility
from ...scene.storage.sharing import changed_members


class InstanceColumns:
    """Columns with a row for each instance of a scene. Rows of instances that are the very objects of the scene before
    stay as they are: whoever changes an instance gives a new one."""

    def __init__(self) -> None:
        self._instances: list[Instance] = []
        self.meshes = np.zeros(0, np.int64)
        """(n,) the mesh of each, by its place in the scene."""
        self.materials = np.zeros(0, np.int64)
        """(n,) the number of the materials of each, among ``material_lists``."""
        self.material_lists: list[tuple[int, ...]] = []
        """Different materials of the slots of instances."""
        self.visibility = np.zeros(0, np.int64)
        """(n,) the RayVisibility of each."""
        self.mirrors_see_others = False
        """True where glossy rays see some instances that stop no shadow rays, or the other way round."""
        self.sets = np.zeros(0, np.int64)
        """(n,) the sets of lights that shine on each, and of shadows that it stops, in the lower bits of codes."""
        self.are_linked, self.catch_shadows = np.zeros((2, 0), bool)
        """(n,) True where an instance has Light Linking, and where it is a shadow catcher."""
        self.matrices = np.zeros((0, 4, 4))
        """(n, 4, 4) object to world."""
        self._numbers: dict[tuple[int, ...], int] = {}

    def follow(self, instances: list[Instance]) -> np.ndarray:
        """Take the instances of a scene; returns the rows that were read, ascending int64."""
        count = len(instances)
        if len(self._instances) != count:
            self._numbers.clear()
            self.meshes, self.materials = np.zeros((2, count), np.int64)
            self.visibility, self.sets = np.zeros((2, count), np.int64)
            self.are_linked, self.catch_shadows = np.zeros((2, count), bool)
            self.matrices = np.zeros((count, 4, 4))
            rows = np.arange(count)
        else:
            rows = changed_members(self._instances, instances)
        self._instances = []  # should one of them be none
        some = instances if len(rows) == count else [instances[row] for row in rows.tolist()]
        self.meshes[rows] = column(some, "mesh", np.int64)
        self.visibility[rows] = column(some, "visibility", np.int64)
        both = self.visibility & (RayVisibility.SHADOW | RayVisibility.GLOSSY)
        self.mirrors_see_others = bool(np.isin(both, (RayVisibility.SHADOW, RayVisibility.GLOSSY)).any())
        self.sets[rows] = column(some, "linking", np.int64, _packed_sets)
        self.are_linked[rows] = column(some, "linking", bool, lambda linking: linking is not None)
        self.catch_shadows[rows] = column(some, "shadow_catcher", bool)
        self.materials[rows] = numbered(map(operator.attrgetter("materials"), some), self._numbers)
        self.material_lists = list(self._numbers)
        if some:
            self.matrices[rows] = np.array([instance.matrix for instance in some], np.float64)
        self._instances = list(instances)
        return rows

    def have(self, materials: set[int]) -> np.ndarray:
        """(n,) bool, the instances with any of these materials."""
        lists = np.array([not materials.isdisjoint(of_slots) for of_slots in self.material_lists], bool)
        return lists[self.materials]


def column(members: Sequence, name: str, dtype: type, of_value: Callable[[Any], float] | None = None) -> np.ndarray:
    """(n,) what an attribute of each member says, or what a function makes of its value."""
    values = map(operator.attrgetter(name), members)
    if of_value is None:
        return np.fromiter(values, dtype, len(members))
    return np.fromiter(map(of_value, values), dtype, len(members))


def numbered(lists: Iterable[Sequence[int]], numbers: dict[tuple[int, ...], int]) -> np.ndarray:
    """(n,) int64 numbers of lists, the same for equal ones. ``numbers``: those that are known, to which new ones are
    added."""
    return np.array([numbers.setdefault(key, len(numbers)) for key in map(tuple, lists)], np.int64)


def _packed_sets(linking: LightLinking | None) -> int:
    return 0 if linking is None else linking.receiver_light_set | linking.blocker_shadow_set << 6
