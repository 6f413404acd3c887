# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of strands and points that nodes read."""

import bpy
import numpy as np

from ...common.hashing import hashed_up_to
from ..meshes.attributes import attribute_values
from .tubes import Rings, Strands

INTERCEPT, LENGTH, THICKNESS, CURVE_RANDOM = ".intercept", ".length", ".thickness", ".curve_random"
"""Names of the exported values of Hair Info."""
POINT_PLACE, POINT_RADIUS, POINT_RANDOM = ".point_position", ".point_radius", ".point_random"
"""Names of the exported values of Point Info."""
OF_ROUND_SHAPES = {INTERCEPT, LENGTH, THICKNESS, CURVE_RANDOM, POINT_PLACE, POINT_RADIUS, POINT_RANDOM}
"""Attributes of hair and points. A surface that lacks them gets no warning."""


def strand_values(strands: Strands, rings: Rings, name: str) -> np.ndarray | None:
    """(vertices, 1) float32 of tubes, what Hair Info tells; None of anything else."""
    if name == THICKNESS:
        return rings.per_vertex(rings.of_keys(2.0 * strands.radii[:, None]))
    if name == CURVE_RANDOM:
        kept = strands.kept
        numbers = hashed_up_to(len(strands.slots) if kept is None else len(kept))
        return rings.per_vertex(rings.of_strands((numbers if kept is None else numbers[kept])[:, None]))
    if name not in {INTERCEPT, LENGTH}:
        return None
    steps = np.zeros(len(strands.keys), np.float64)
    steps[1:] = np.linalg.norm(strands.keys[1:] - strands.keys[:-1], axis=1)
    firsts = strands.starts[:-1]
    steps[firsts] = 0.0
    passed = np.cumsum(steps)
    whole = passed[strands.starts[1:] - 1] - passed[firsts]
    if name == LENGTH:
        return rings.per_vertex(rings.of_strands(whole[:, None].astype(np.float32)))
    counts = np.diff(strands.starts)
    passed -= np.repeat(passed[firsts], counts)
    fractions = np.divide(
        passed, np.repeat(whole, counts), out=np.zeros_like(passed), where=np.repeat(whole > 0.0, counts)
    )
    return rings.per_vertex(rings.of_keys(fractions[:, None].astype(np.float32)))


def read_values(data: bpy.types.Curves | bpy.types.PointCloud, name: str) -> tuple[np.ndarray, str] | None:
    """(n, components) float32 of an attribute of curves or points, 0 where it is not finite, and its domain; None when
    there is none."""
    attribute = data.attributes.get(name)
    values = None if attribute is None else attribute_values(attribute)
    return None if values is None else (values, attribute.domain)
