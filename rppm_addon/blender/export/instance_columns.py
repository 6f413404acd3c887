# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender tells of all instances of a depsgraph at once, which takes far less time than asking each."""

import bpy
import numpy as np

_FEW = 32


class InstanceColumns:
    """In the order of ``depsgraph.object_instances``, one entry an instance."""

    def __init__(self, depsgraph: bpy.types.Depsgraph) -> None:
        instances = depsgraph.object_instances
        self.matrices = _matrices(instances)
        """(n, 4, 4) float64, object to world."""
        count = len(self.matrices)
        self.multiplied: list[bool] = _read(instances, "is_instance", count, bool).tolist()
        self.shows_self: list[bool] = _read(instances, "show_self", count, bool).tolist()
        identifiers = _read(instances, "random_id", count, np.int32).view(np.uint32)
        self.randoms: list[float] = (identifiers / np.float64(0xFFFFFFFF)).tolist()
        """From 0 to 1, of those that are multiplied."""


def matrices_of(depsgraph: bpy.types.Depsgraph, sources: list[bpy.types.Object]) -> np.ndarray:
    """(n, 4, 4) float64, object to world, of evaluated objects."""
    if len(sources) < _FEW:
        return np.array([source.matrix_world for source in sources], np.float64).reshape(-1, 4, 4)
    places = {known.as_pointer(): place for place, known in enumerate(depsgraph.objects)}
    return _matrices(depsgraph.objects)[[places[source.as_pointer()] for source in sources]]


def _read(collection: bpy.types.bpy_prop_collection, name: str, count: int, kind: type) -> np.ndarray:
    values = np.empty(count, kind)
    if count:
        collection.foreach_get(name, values)
    return values


def _matrices(collection: bpy.types.bpy_prop_collection) -> np.ndarray:
    """Blender gives them column by column."""
    values = _read(collection, "matrix_world", 16 * len(collection), np.float32)
    return values.reshape(-1, 4, 4).swapaxes(1, 2).astype(np.float64, order="C")
