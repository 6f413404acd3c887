# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes that geometry nodes give their instances, which nodes of materials read by Instancer.

Blender does not say which instance of geometry nodes one of a depsgraph is; its persistent identifier does: a number
for each level of what multiplies what (Blender's object_dupli.cc).
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import bpy
import numpy as np

from ..geometry.meshes.attributes import INSTANCER_GENERATED, INSTANCER_UV, attribute_values

_NO_NUMBER = 0x7FFFFFFF
"""Ends a persistent identifier that has fewer levels than the eight that it has room for."""
_PARTS = ("mesh", "curves", "pointcloud", "volume", "grease_pencil")
"""Components that a geometry set may have beside its instances."""


@dataclass(slots=True)
class _Level:
    """The instances of a geometry set."""

    has_parts: bool
    """Whether it brings anything but instances, which then have a number before their own."""
    numbers: np.ndarray
    """Numbers of instances, as far as they are known, ascending."""
    places: np.ndarray
    """Places of the instances that have these numbers."""
    repeated: np.ndarray
    """Places that have the number of one before, as in what is joined of the same points: Blender makes up others."""
    values: dict[str, np.ndarray]
    """By name, (instances, 4) as colors."""
    references: np.ndarray
    """Index into ``sources`` of what each instance multiplies."""
    sources: list["_Source"]

    def find(self, numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return whether numbers (n,) are known, (n,) bool, and the places (n,) of those that are."""
        if len(self.numbers) == 0:
            return np.zeros(len(numbers), bool), np.zeros(len(numbers), np.int64)
        at = np.minimum(np.searchsorted(self.numbers, numbers), len(self.numbers) - 1)
        return self.numbers[at] == numbers, self.places[at]

    def learn(self, numbers: list[int]) -> None:
        """Give the repeated places numbers that Blender made up."""
        joined = np.concatenate([self.numbers, numbers])
        self.numbers, first = np.unique(joined[::-1], return_index=True)  # the newest of a number counts
        self.places = np.concatenate([self.places, self.repeated])[::-1][first]


@dataclass(slots=True)
class _Members:
    """Objects of a collection, by their numbers."""

    sources: list["_Source"]


_Source = _Level | _Members | None
"""Geometry set or collection that may multiply further objects; None where nothing is multiplied further."""


_Column = tuple[np.ndarray, np.ndarray]
"""An attribute of many instances: (n,) bool, whether each has it, and (n, 4) float32, as colors."""


class InstanceAttributes:
    """Looks them up. Of Blender it holds nothing."""

    def __init__(self) -> None:
        self.depsgraph: bpy.types.Depsgraph | None = None
        """Depsgraph of the instances while any are asked about, or else None."""
        self._sources: dict[int, _Source] = {}
        """Sources of evaluated objects, by the addresses of the objects."""
        self._completed: set[int] = set()
        """Addresses of those whose made up numbers were looked at."""

    def forget(self) -> None:
        """Forget all sources, because the objects that multiply others may have changed."""
        self._sources = {}
        self._completed = set()

    def value(self, instance: bpy.types.DepsgraphObjectInstance, name: str) -> tuple[float, ...] | None:
        """Return an attribute of a name that begins with INSTANCER, as a color, from the innermost level that has it;
        None where none has."""
        if name in COORDINATES:
            place = COORDINATES[name](np.array([instance.orco], np.float64), np.array([instance.uv], np.float64))
            return tuple(place[0].tolist())
        path = name.partition(":")[2]
        owner, numbers = instance.parent, _numbers(instance)
        source, address = self._source(owner), owner.as_pointer()
        levels, unknown = _walk(source, numbers)
        if unknown is not None and address not in self._completed:
            self._completed.add(address)
            self._complete(source, address)
            levels, _ = _walk(source, numbers)
        found = (level.values[path][place] for level, place in reversed(levels) if path in level.values)
        value = next(found, None)
        return None if value is None else tuple(value.tolist())

    def has_any(self, owner: bpy.types.Object) -> bool:
        """Return whether what an evaluated object multiplies may have attributes of its own."""
        return self._source(owner) is not None

    def columns(self, owner: int, identifiers: np.ndarray, names: Iterable[str]) -> dict[str, _Column]:
        """Return the attributes of many instances, by their names in geometry nodes, as value() finds them.

        owner: address of the object that multiplies all of them, of which has_any() was asked. identifiers: (n, 8)
        int32, their persistent identifiers.
        """
        source, count = self._sources[owner], len(identifiers)
        levels = (identifiers != _NO_NUMBER).sum(axis=1)
        order = levels[:, None] - 1 - np.arange(identifiers.shape[1])
        paths = np.where(order >= 0, np.take_along_axis(identifiers, np.maximum(order, 0), axis=1), _NO_NUMBER)
        paths = np.concatenate([paths, np.full((count, 1), _NO_NUMBER)], axis=1)
        found = {name: (np.zeros(count, bool), np.zeros((count, 4), np.float32)) for name in names}
        if not _fill(found, source, paths, np.arange(count), 0) and owner not in self._completed:
            self._completed.add(owner)
            self._complete(source, owner)
            _fill(found, source, paths, np.arange(count), 0)
        return found

    def _source(self, owner: bpy.types.Object) -> _Source:
        address = owner.as_pointer()
        if address not in self._sources:
            self._sources[address] = self._read(owner)
        return self._sources[address]

    def _read(self, owner: bpy.types.Object) -> _Source:
        if owner.instance_type == "COLLECTION":
            collection = owner.instance_collection
            return None if collection is None else _Members([self._source(each) for each in collection.all_objects])
        if not hasattr(owner, "evaluated_geometry"):  # before Blender 4.5
            return None
        if all(modifier.type != "NODES" for modifier in owner.modifiers):
            return None
        return self._level(owner.evaluated_geometry(), owner, False)

    def _complete(self, source: _Source, address: int) -> None:
        """Find out the numbers that Blender made up: they come in the order of the instances."""
        shown = (each for each in self.depsgraph.object_instances if each.is_instance)
        paths = [_numbers(each) for each in shown if each.parent.as_pointer() == address]
        while True:
            made_up: dict[int, tuple[_Level, dict[int, None]]] = {}
            for path in paths:
                _, unknown = _walk(source, path)
                if unknown is not None:
                    level, number = unknown
                    made_up.setdefault(id(level), (level, {}))[1][number] = None
            # Of some that multiply nothing no number is seen: then all of that level stay unknown.
            found = [(level, numbers) for level, numbers in made_up.values() if len(numbers) == len(level.repeated)]
            if not found:
                return
            for level, numbers in found:
                level.learn(list(numbers))

    def _level(self, geometry: "bpy.types.GeometrySet", owner: bpy.types.Object, is_multiplied: bool) -> _Level | None:
        points = geometry.instances_pointcloud()
        if points is None:
            return None
        attributes = points.attributes
        count = len(attributes["position"].data)
        given = _integers(attributes["id"]) if "id" in attributes else np.arange(count)
        numbers, places = np.unique(given, return_index=True)  # the first of a number
        own = {"MESH": "mesh", "CURVES": "curves", "CURVE": "curves", "FONT": "curves", "POINTCLOUD": "pointcloud"}
        parts = _PARTS if is_multiplied else [part for part in _PARTS if part != own.get(owner.type)]
        return _Level(
            any(getattr(geometry, part, None) is not None for part in parts),
            numbers,
            places,
            np.setdiff1d(np.arange(count), places),
            {attribute.name: color for attribute in attributes if (color := _colors(attribute)) is not None},
            _integers(attributes[".reference_index"]),
            [self._referenced(each, owner) for each in geometry.instance_references()],
        )

    def _referenced(self, reference: object, owner: bpy.types.Object) -> _Source:
        if isinstance(reference, bpy.types.Object):
            return self._source(reference)
        # Objects of collections have numbers that depend on what is hidden: their own instances are not looked for.
        return self._level(reference, owner, True) if isinstance(reference, bpy.types.GeometrySet) else None


def _numbers(instance: bpy.types.DepsgraphObjectInstance) -> list[int]:
    """From the outermost level on."""
    return [number for number in instance.persistent_id if number != _NO_NUMBER][::-1]


def _walk(source: _Source, numbers: list[int]) -> tuple[list[tuple[_Level, int]], tuple[_Level, int] | None]:
    """Where numbers lead: each level with the place of its instance, from the outermost on, and the first level that
    does not know its number, with that."""
    levels: list[tuple[_Level, int]] = []
    while source is not None and numbers:
        if isinstance(source, _Members):
            inside = 0 <= numbers[0] < len(source.sources)
            source, numbers = source.sources[numbers[0]] if inside else None, numbers[1:]
            continue
        numbers = numbers[source.has_parts :]
        if not numbers:
            break
        is_known, places = source.find(np.array(numbers[:1]))
        if not is_known[0]:
            return levels, (source, numbers[0])
        place = int(places[0])
        levels.append((source, place))
        source, numbers = source.sources[source.references[place]], numbers[1:]
    return levels, None


def _fill(found: dict[str, _Column], source: _Source, paths: np.ndarray, rows: np.ndarray, depth: int) -> bool:
    """Fill in the attributes of instances, from the outermost level that has them to the innermost, as _walk goes.

    paths: (n, 9) numbers of all instances from the outermost level on. rows: instances that lead here. depth: the
    level. Returns whether all numbers are known.
    """
    if source is None:
        return True
    rows = rows[paths[rows, depth] != _NO_NUMBER]
    if len(rows) == 0:
        return True
    if isinstance(source, _Members):
        numbers = paths[rows, depth]
        inside = [number for number in np.unique(numbers).tolist() if 0 <= number < len(source.sources)]
        parts = [_fill(found, source.sources[number], paths, rows[numbers == number], depth + 1) for number in inside]
        return all(parts)
    depth += source.has_parts
    rows = rows[paths[rows, depth] != _NO_NUMBER]
    is_known, places = source.find(paths[rows, depth])
    rows, places = rows[is_known], places[is_known]
    for name, (is_found, values) in found.items():
        if name in source.values:
            is_found[rows] = True
            values[rows] = source.values[name][places]
    references = source.references[places]
    parts = [
        _fill(found, source.sources[reference], paths, rows[references == reference], depth + 1)
        for reference in np.unique(references).tolist()
    ]
    return bool(is_known.all()) and all(parts)


def _integers(attribute: bpy.types.Attribute) -> np.ndarray:
    values = np.empty(len(attribute.data), np.int32)
    attribute.data.foreach_get("value", values)
    return values


def _colors(attribute: bpy.types.Attribute) -> np.ndarray | None:
    """As Blender converts them: a number is gray, what is missing of a vector 0, and a rotation is no color."""
    values = None if attribute.data_type == "QUATERNION" else attribute_values(attribute)
    if values is None:
        return None
    colors = np.zeros((len(values), 4), np.float32)
    colors[:, 3] = 1.0
    width = values.shape[1]
    colors[:, : 3 if width == 1 else width] = values
    return colors


@dataclass(frozen=True)
class AttributeRows:
    """Attributes of the instances of one object by one instancer in a slice of a pass over a depsgraph."""

    shared: dict[str, tuple[float, ...]]
    """Values by name where an instance has none of its own."""
    own: dict[str, _Column]
    """Values of instances by name, of which at least one has each."""

    def are_whole(self, count: int) -> np.ndarray:
        """(n,) bool, True where one of n instances has all attributes that any of them has of its own."""
        return np.all([np.ones(count, bool), *(found for found, _ in self.own.values())], axis=0)

    def columns(self, chosen: np.ndarray) -> dict[str, np.ndarray]:
        """(n, channels) float64 by name, what chosen instances have of their own."""
        return {name: values[chosen].astype(np.float64) for name, (_, values) in self.own.items()}

    def __getitem__(self, place: int) -> dict[str, tuple[float, ...]]:
        """All attributes of one instance."""
        own = {name: tuple(values[place].tolist()) for name, (found, values) in self.own.items() if found[place]}
        return self.shared | own


class AttributeNotes:
    """Notes what tells the attributes of the instances of one object by one instancer."""

    def __init__(
        self,
        attributes: InstanceAttributes,
        owner: bpy.types.Object,
        names: Iterable[str],
        shared: dict[str, tuple[float, ...]],
    ) -> None:
        """owner: what multiplies the object. names: attributes that each instance may have of its own. shared: values
        of attributes by name, where instances have none of their own."""
        self._attributes = attributes
        self._owner = owner.as_pointer()
        self._coordinates = [name for name in names if name in COORDINATES]
        self._names = [name for name in names if name not in COORDINATES] if attributes.has_any(owner) else []
        self._shared = shared
        self._identifiers: list[tuple[int, ...]] = []
        self._places: list[tuple[float, ...]] = []

    def add(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        """Note an instance."""
        if self._names:
            self._identifiers.append(instance.persistent_id[:])
        if self._coordinates:
            self._places.append((*instance.orco, *instance.uv))

    def end(self) -> AttributeRows:
        """Return the attributes of the instances that were noted since the last call."""
        found: dict[str, _Column] = {}
        if self._names:
            paths = {name.partition(":")[2] for name in self._names} - {""}
            identifiers, self._identifiers = np.array(self._identifiers, np.int32), []
            columns = self._attributes.columns(self._owner, identifiers, paths)
            found = {f"INSTANCER:{path}": column for path, column in columns.items() if column[0].any()}
        if self._coordinates:
            places, self._places = np.array(self._places, np.float64), []
            there = np.ones(len(places), bool)
            found |= {name: (there, COORDINATES[name](places[:, :3], places[:, 3:])) for name in self._coordinates}
        return AttributeRows(self._shared, found)


COORDINATES: dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    INSTANCER_GENERATED: lambda generated, _: 0.5 * generated - 0.5,
    INSTANCER_UV: lambda _, uv: np.concatenate([uv, np.zeros((len(uv), 1))], axis=1),
}
"""Functions that return the coordinates of instances on the object that multiplies them, (n, 3), of Blender's generated
coordinates (n, 3) and UV (n, 2), by attribute name, as in Cycles. An object that stands for itself has zeros."""
