# SPDX-License-Identifier: GPL-3.0-or-later
"""Placement of the deep cubemap's center."""

from collections.abc import Iterator

import numpy as np

from ...scene.scene import Scene
from ..surfaces.geometry import Geometry

FAR = 4.0
"""Times the scene's radius: from farther off, the margins of cells would outgrow small triangles."""

_NUDGE = np.array([0.00307, -0.00251, 0.00193])
"""Fractions of the scene's radius, unlikely to put the center on a surface or a plane of symmetry."""


def cubemap_centers(scene: Scene, geometry: Geometry) -> Iterator[np.ndarray]:
    """(3,) points, meters, the best first: the scene's own choice if it has one, else the camera.

    From the camera what is seen is cut as finely as it is looked at, camera rays stay in the cell that they
    start in, and the measured cost of all other rays is about that of any other place. A camera far outside
    of the scene is brought nearer. The points that follow are for where the center lies in a surface.
    """
    wanted = scene.camera.matrix[:3, 3] if scene.cubemap_center is None else np.asarray(scene.cubemap_center, float)
    offset = wanted - geometry.center
    distance = float(np.linalg.norm(offset))
    if not np.isfinite(distance):
        offset, distance = np.zeros(3), 0.0
    point = geometry.center + offset * min(1.0, FAR * geometry.radius / max(distance, 1e-30))
    yield point
    for fraction in (0.1, 0.5, 2.0):
        yield point + fraction * _NUDGE * geometry.radius


def radius_about(center: np.ndarray, geometry: Geometry) -> float:
    """The greatest distance from a point to the scene's bounds, meters: no triangle lies farther out."""
    return float(np.linalg.norm(np.maximum(center - geometry.bounds_low, geometry.bounds_high - center)))
