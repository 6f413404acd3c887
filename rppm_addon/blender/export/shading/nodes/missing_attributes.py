# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes that materials read and objects do not have, so that none counts as 0 in silence."""

from typing import Protocol

import numpy as np

from .....scene import Material, Mesh
from .....scene.meshes import SMOOTH_NORMALS
from ...common.report import Report
from ...geometry.meshes.attributes import GENERATED, ISLAND, POINTINESS, TANGENT, title_of
from ...geometry.strands.attributes import OF_ROUND_SHAPES

_OF_ALL_MESHES = frozenset({GENERATED, ISLAND, POINTINESS, SMOOTH_NORMALS, TANGENT, *OF_ROUND_SHAPES})
"""Attributes that no mesh lacks."""


class _Instance(Protocol):
    """An instance, or the description of one."""

    mesh: int | None
    materials: list[int]
    object_name: str
    attributes: dict[str, tuple[float, ...]]


class MissingAttributes:
    """Collects attributes that materials read of instances that do not have them."""

    def __init__(self, meshes: list[Mesh], materials: list[Material], attributes: list[dict[str, str]]) -> None:
        """attributes: the attributes that each material reads, each with the name of a node that reads it."""
        self._meshes = meshes
        self._materials = materials
        self._attributes = attributes
        self._objects: dict[tuple[str, str, str], dict[str, None]] = {}
        """Names of the objects that lack an attribute, by the names of material, node and attribute."""
        self._lacks_nothing: set[tuple] = set()
        """Keys of instances that have all attributes that their materials read. A key holds the mesh, the number of the
        mesh's attributes, the materials, and the names of the instance's own attributes."""

    def note(self, instance: _Instance) -> None:
        """Take note of the attributes that an instance, or the description of one, lacks."""
        mesh = self._meshes[instance.mesh]
        key = instance.mesh, len(mesh.attributes), tuple(instance.materials), tuple(instance.attributes)
        if key in self._lacks_nothing:
            return
        known = {*_OF_ALL_MESHES, *mesh.attributes, *instance.attributes}
        asked = [(slot, self._attributes[material]) for slot, material in enumerate(instance.materials)]
        if all(attributes.keys() <= known for _, attributes in asked):
            self._lacks_nothing.add(key)
            return
        slots = np.flatnonzero(np.bincount(np.minimum(mesh.triangle_slots, len(asked) - 1)))
        for slot, attributes in asked:
            for attribute in attributes.keys() - known if slot in slots else ():
                material = self._materials[instance.materials[slot]].name
                objects = self._objects.setdefault((material, attributes[attribute], attribute), {})
                objects[instance.object_name] = None

    def warn(self, report: Report) -> None:
        """Have the report name the attributes, each with an object that lacks it."""
        for (material, node, attribute), objects in sorted(self._objects.items()):
            first = next(iter(objects))
            lack = f'object "{first}" lacks' if len(objects) == 1 else f'{len(objects)} objects lack, such as "{first}"'
            report.warn(
                f'Material "{material}": node "{node}" reads {title_of(attribute)}, which {lack}; it counts as 0'
            )
