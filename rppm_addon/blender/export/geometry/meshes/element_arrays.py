# SPDX-License-Identifier: GPL-3.0-or-later
"""Elements of Blender meshes as arrays, read where they lie if that is right."""

import ctypes
import logging

import bpy
import numpy as np

logger = logging.getLogger(__name__)

_SAMPLES = 1 << 10
"""Elements of a large mesh that are compared."""
_views_are_right: dict[tuple[str, str], bool] = {}
"""By kind of element and its field, what the first mesh of this session with two elements or more has shown."""


def elements(collection: bpy.types.bpy_prop_collection, field: str, count: int, width: int, kind: type) -> np.ndarray:
    """A field of all elements: (count, width), or (count,) for a width of 1.

    May lie in Blender's memory: nobody may write to it, and who keeps it copies it before Blender is asked for
    anything else.
    """
    if count < 2:
        return _by_foreach_get(collection, field, count, width, kind)
    key = type(collection[0]).__name__, field
    if key not in _views_are_right:
        _views_are_right[key] = view_is_right(collection, field, count, width, kind)
        if not _views_are_right[key]:
            logger.info("Blender's %s do not lie in a row; they are read through foreach_get", key[0])
    if _views_are_right[key]:
        return _by_pointer(collection, count, width, kind)
    return _by_foreach_get(collection, field, count, width, kind)


def attribute_elements(
    mesh: bpy.types.Mesh, name: str, field: str, count: int, width: int, kind: type
) -> np.ndarray | None:
    """The array that ``elements`` gives of a mesh's attribute; None where there is none, as always in Edit Mode."""
    attribute = None if mesh.is_editmode else mesh.attributes.get(name)
    return None if attribute is None else elements(attribute.data, field, count, width, kind)


def view_is_right(collection: bpy.types.bpy_prop_collection, field: str, count: int, width: int, kind: type) -> bool:
    """Whether Blender stores these elements as so many numbers in a row, and foreach_get agrees.

    That layout is not documented, but reading triangles so is some hundred times quicker than by foreach_get.
    """
    # Reading past the array is what no comparison would survive: first ask Blender for the
    # addresses of the first, the second and the last element.
    start, size = collection[0].as_pointer(), width * np.dtype(kind).itemsize
    places = sorted({1, *range(0, count, -(-count // _SAMPLES)), count - 1})
    if any(collection[place].as_pointer() - start != size * place for place in places):
        return False
    found = _by_pointer(collection, count, width, kind)
    if count > _SAMPLES:  # asking for all of a large mesh takes longer than reading it
        asked = np.array([getattr(collection[place], field) for place in places], kind)
        return found[places].tobytes() == asked.tobytes()
    return found.tobytes() == _by_foreach_get(collection, field, count, width, kind).tobytes()


def _by_pointer(collection: bpy.types.bpy_prop_collection, count: int, width: int, kind: type) -> np.ndarray:
    size = count * width * np.dtype(kind).itemsize
    memory = (ctypes.c_char * size).from_address(collection[0].as_pointer())
    return _shaped(np.frombuffer(memory, kind), width)


def _by_foreach_get(
    collection: bpy.types.bpy_prop_collection, field: str, count: int, width: int, kind: type
) -> np.ndarray:
    values = np.empty(count * width, kind)
    collection.foreach_get(field, values)
    return _shaped(values, width)


def _shaped(values: np.ndarray, width: int) -> np.ndarray:
    return values if width == 1 else values.reshape(-1, width)
