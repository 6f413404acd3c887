# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the deep cubemap's centre goes."""

import numpy as np

from ..scene.camera import Camera
from .geometry import Geometry

_MARGIN = 0.1
_NUDGE = np.array([0.00307, -0.00251, 0.00193])
"""Shares of the scene's radius, unlikely to put the centre on a surface or a plane of symmetry."""


def cubemap_centre(camera: Camera, geometry: Geometry) -> np.ndarray:
    """(3,) the point within the scene's bounds, less a margin, that is nearest to the camera.

    Rays that start near the centre are the fastest (camera rays then), and a centre outside of
    the geometry would see it in a few cells only.
    """
    margin = _MARGIN * (geometry.bounds_high - geometry.bounds_low)
    point = np.clip(camera.matrix[:3, 3], geometry.bounds_low + margin, geometry.bounds_high - margin)
    return point + _NUDGE * geometry.radius
