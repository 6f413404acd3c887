# SPDX-License-Identifier: GPL-3.0-or-later
"""Radii of the density estimation: Eq. 2, 3 and 4 and their limits."""

import math

import numpy as np

from ..scene.camera import Camera
from ..scene.settings import RenderSettings

_REFERENCE_PIXELS = 1 << 20
EXPECTED_PHOTONS = 8


def shrinkage(iteration: int, alpha: float) -> float:
    """r_i / r_1 of Eq. 2 for the iteration i >= 1: the product of sqrt((k + alpha) / (k + 1)), k < i."""
    k = np.arange(1, iteration)
    return float(np.exp(0.5 * np.sum(np.log((k + alpha) / (k + 1)))))


def radius_in_pixels(settings: RenderSettings, camera: Camera) -> float:
    """s_r of Eq. 3 for this frame: the setting is for 1 megapixel and follows the frame's side."""
    return settings.radius_scale * math.sqrt(camera.width * camera.height / _REFERENCE_PIXELS)


def wide_radius(diffused_photons: int, bounds_low: np.ndarray, bounds_high: np.ndarray) -> float:
    """Radius of the first iteration for photons that a diffuse surface has scattered, metres.

    Such light varies slowly, and its photons are spread over all of the scene: the disk holds
    EXPECTED_PHOTONS of them where they lie evenly on surfaces as large as the bounds' six sides. Once photons
    have been seen, fitted_wide_radius follows them.
    """
    x, y, z = bounds_high - bounds_low
    area = 2.0 * (x * y + y * z + z * x)
    spaced = math.sqrt(EXPECTED_PHOTONS * area / (math.pi * max(diffused_photons, 1)))
    return min(spaced, widest_radius(bounds_low, bounds_high))


def widest_radius(bounds_low: np.ndarray, bounds_high: np.ndarray) -> float:
    """What the wide radius never exceeds, metres: a twentieth of the scene's diagonal."""
    return 0.05 * float(np.linalg.norm(bounds_high - bounds_low))


def fitted_wide_radius(radius: float, shrunk: float, counts: np.ndarray) -> float:
    """The wide radius of the first iteration with which half of the view would find EXPECTED_PHOTONS or more.

    ``counts`` (n,) are those that pixels found with ``radius`` times ``shrunk``; pixels without any may see no
    diffuse surface.
    """
    found = counts[counts > 0]
    return radius * shrunk * math.sqrt(EXPECTED_PHOTONS / float(np.median(found))) if len(found) else radius


def radius_limits(settings: RenderSettings, footprints: np.ndarray, scene_radius: float) -> tuple[float, float]:
    """r_min and r_max of the first iteration, metres.

    ``footprints`` (n,) are the Eq. 3 radii of the camera's first hits. Unset limits follow them:
    r_max, at which all photons are splatted, covers 95 % of the view, and r_min keeps a
    twentieth of the median where a hit lies at the camera's nose.
    """
    seen = footprints[np.isfinite(footprints) & (footprints > 0)]
    middle, high = np.percentile(seen, [50, 95]) if len(seen) else (0.005 * scene_radius,) * 2
    maximum = settings.radius_maximum or min(float(high), 0.25 * scene_radius)
    minimum = settings.radius_minimum or min(0.05 * float(middle), maximum)
    return min(minimum, maximum), maximum
