# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's point clouds."""

from dataclasses import dataclass

import bpy
import numpy as np

from ..meshes.element_arrays import elements

DEFAULT_RADIUS = 0.01
"""Radius of points that have none, in meters, as in Cycles."""


@dataclass
class Points:
    """Spheres in the space of their object."""

    places: np.ndarray
    """(points, 3) float32 meters."""
    radii: np.ndarray
    """(points,) float32 meters."""
    kept: np.ndarray | None = None
    """(points before,) bool, which of them these are; None: all."""


def read_points(data: bpy.types.PointCloud, farthest: float) -> Points:
    """Read an evaluated point cloud, without points that are not finite, beyond ``farthest``, or without extent."""
    count = len(data.points)
    if count == 0:
        return Points(np.zeros((0, 3), np.float32), np.zeros(0, np.float32))
    places = elements(data.attributes["position"].data, "vector", count, 3, np.float32).copy()
    attribute = data.attributes.get("radius")
    if attribute is not None and (attribute.domain, attribute.data_type) == ("POINT", "FLOAT"):
        radii = elements(attribute.data, "value", count, 1, np.float32).copy()
    else:
        radii = np.full(count, DEFAULT_RADIUS, np.float32)
    good = (np.abs(places) < farthest).all(axis=1) & (radii > 0.0) & (radii < farthest)  # false for NaN as well
    return Points(places, radii) if good.all() else Points(places[good], radii[good], good)
