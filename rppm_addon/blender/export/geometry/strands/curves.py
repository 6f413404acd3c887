# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's hair curves as strands."""

import bpy
import numpy as np

from ..meshes.attributes import attribute_values
from ..meshes.element_arrays import elements
from .tubes import Strands

DEFAULT_RADIUS = 0.005
"""Radius of curves that have none, in meters, as in Cycles."""


def read_curves(data: bpy.types.Curves) -> Strands:
    """The control points of evaluated hair curves."""
    count = len(data.points)
    if count == 0:  # and Blender has no offsets, not even the end's
        return Strands(
            np.zeros((0, 3), np.float32), np.zeros(0, np.float32), np.zeros(1, np.int32), np.zeros(0, np.int32)
        )
    starts = np.empty(len(data.curves) + 1, np.int32)
    data.curve_offset_data.foreach_get("value", starts)
    keys = elements(data.attributes["position"].data, "vector", count, 3, np.float32).copy()
    slots = np.zeros(len(data.curves), np.int32)
    return Strands(keys, _radii(data, count), starts, slots, not _is_straight(data))


def _radii(data: bpy.types.Curves, count: int) -> np.ndarray:
    attribute = data.attributes.get("radius")
    if attribute is None or (attribute.domain, attribute.data_type) != ("POINT", "FLOAT"):
        return np.full(count, DEFAULT_RADIUS, np.float32)
    return elements(attribute.data, "value", count, 1, np.float32).copy()


def _is_straight(data: bpy.types.Curves) -> bool:
    """Whether curves go straight from point to point: Cycles of Blender 5 takes the type of the first for all."""
    if bpy.app.version < (5, 0) or len(data.curves) == 0:
        return False
    attribute = data.attributes.get("curve_type")
    return attribute is not None and attribute.data[0].value == _POLY


_POLY = 1
"""Blender's number of that type of curves."""


def surface_uv(data: bpy.types.Curves) -> np.ndarray | None:
    """(curves, 2) float32, where the curves grow on their surface: as in Cycles the first pair of numbers that curves
    have; None without one."""
    for attribute in data.attributes:
        if (attribute.domain, attribute.data_type) == ("CURVE", "FLOAT2"):
            return attribute_values(attribute)
    return None
