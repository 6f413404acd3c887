# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes that geometry nodes give their instances, which nodes of materials read by Instancer.

Blender does not say which instance of geometry nodes one of a depsgraph is; its persistent identifier does: a number
for each level of what multiplies what (Blender's object_dupli.cc).
"""

from dataclasses import dataclass

import bpy
import numpy as np

from ..geometry.meshes.attributes import attribute_values

_NO_NUMBER = 0x7FFFFFFF
"""Ends a persistent identifier that has fewer levels than the eight that it has room for."""
_PARTS = ("mesh", "curves", "pointcloud", "volume", "grease_pencil")
"""Components that a geometry set may have beside its instances."""


@dataclass(slots=True)
class _Level:
    """The instances of a geometry set."""

    has_parts: bool
    """Whether it brings anything but instances, which then have a number before their own."""
    places: dict[int, int]
    """By their numbers, as far as these are known."""
    repeated: list[int]
    """Places that have the number of one before, as in what is joined of the same points: Blender makes up others."""
    values: dict[str, np.ndarray]
    """By name, (instances, 4) as colors."""
    references: np.ndarray
    """Index into ``sources`` of what each instance multiplies."""
    sources: list["_Source"]


@dataclass(slots=True)
class _Members:
    """Objects of a collection, by their numbers."""

    sources: list["_Source"]


_Source = _Level | _Members | None
"""Geometry set or collection that may multiply further objects; None where nothing is multiplied further."""


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
        """Return the attribute of that name as a color, from the innermost level that has it; None where none has."""
        if not name:
            return None
        owner, numbers = instance.parent, _numbers(instance)
        source, address = self._source(owner), owner.as_pointer()
        levels, unknown = _walk(source, numbers)
        if unknown is not None and address not in self._completed:
            self._completed.add(address)
            self._complete(source, address)
            levels, _ = _walk(source, numbers)
        found = (level.values[name][place] for level, place in reversed(levels) if name in level.values)
        value = next(found, None)
        return None if value is None else tuple(value.tolist())

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
                level.places.update(zip(numbers, level.repeated, strict=True))

    def _level(self, geometry: "bpy.types.GeometrySet", owner: bpy.types.Object, is_multiplied: bool) -> _Level | None:
        points = geometry.instances_pointcloud()
        if points is None:
            return None
        attributes = points.attributes
        count = len(attributes["position"].data)
        numbers = _integers(attributes["id"]) if "id" in attributes else range(count)
        places = {number: place for place, number in reversed(list(enumerate(numbers)))}
        own = {"MESH": "mesh", "CURVES": "curves", "CURVE": "curves", "FONT": "curves", "POINTCLOUD": "pointcloud"}
        parts = _PARTS if is_multiplied else [part for part in _PARTS if part != own.get(owner.type)]
        return _Level(
            any(getattr(geometry, part, None) is not None for part in parts),
            places,
            sorted(set(range(count)) - set(places.values())),
            {attribute.name: color for attribute in attributes if (color := _colors(attribute)) is not None},
            np.array(_integers(attributes[".reference_index"])),
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
        place = source.places.get(numbers[0])
        if place is None:
            return levels, (source, numbers[0])
        levels.append((source, place))
        source, numbers = source.sources[source.references[place]], numbers[1:]
    return levels, None


def _integers(attribute: bpy.types.Attribute) -> list[int]:
    values = np.empty(len(attribute.data), np.int32)
    attribute.data.foreach_get("value", values)
    return values.tolist()


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
