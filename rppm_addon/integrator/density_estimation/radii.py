# SPDX-License-Identifier: GPL-3.0-or-later
"""Radii of the density estimation: Eq. 2, 3 and 4 and their limits."""

import math
from dataclasses import dataclass

import numpy as np

from ...scene.camera import Camera
from ...scene.settings import RenderSettings

_REFERENCE_PIXELS = 1 << 20
EXPECTED_PHOTONS, EXPECTED_BY_GATHERING = 8, 16
"""Global photons in the wide radius: where the camera looks, and at the ends of gathering rays, where nobody sees
how wide it is."""
_MAX_CAUSTIC_RADII = 3.0
EXPECTED_CAUSTIC_PHOTONS = 30
"""Caustic photons that a disk of the first iteration holds, if it is wider than Eq. 3's: a pixel's, or that of a photon
by its footprint."""
_MAX_FACTOR = 4.0
CORNER_RADII = 2.0
"""A gathering ray of at most so many wide radii ends in a corner."""


RADIUS_PARAMETERS = {
    "radius_scale": "float",
    "radius_minimum": "float",
    "radius_maximum": "float",
    "final_gather_radius": "float",
    "maximum_radius_factor": "float",
    "wide_radius": "float",
    "gathers_again_below": "float",
}
"""Members of IterationParameters: those of shaders/camera_paths/importons/radius.glsl; the largest radius for photons
that diffuse surfaces have scattered, meters; and the length, meters, below which a gathering ray does not end the
search."""


@dataclass(frozen=True)
class SplatRadii:
    """Largest radii of an iteration, meters."""

    narrow: float
    """r_max of Eq. 3."""
    wide: float
    """Photons that a diffuse surface has scattered; importons with a larger radius of their own keep that."""
    max_factor: float = 1.0
    """The most that the radii for caustics are times Eq. 3's (caustic_radii.py)."""

    @property
    def caustic(self) -> float:
        """Caustics where the camera's paths come to by specular surfaces."""
        return self.max_factor * self.narrow

    @property
    def final_gather(self) -> float:
        """Caustics there or at the ends of gathering rays."""
        return max(self.caustic, final_gather_radius(self.narrow, self.wide))


@dataclass(frozen=True)
class Radii:
    """Radii of an iteration: those of the first one, and how far Eq. 2 has shrunk them since."""

    minimum: float
    """r_min of the first iteration, meters."""
    maximum: float
    """r_max of the first iteration, meters."""
    wide: float
    """For photons that a diffuse surface has scattered, of the first iteration, meters."""
    scale: float
    """s_r of Eq. 3."""
    max_factor: float
    """Times Eq. 3's radius, what all pixels begin with for caustics."""
    shrinkage: float
    """r_i / r_1 of Eq. 2."""

    @property
    def splats(self) -> SplatRadii:
        """The iteration's largest ones."""
        return SplatRadii(self.maximum * self.shrinkage, self.wide * self.shrinkage, self.max_factor)

    @property
    def final_gather(self) -> float:
        """For caustics at the ends of gathering rays, meters."""
        return final_gather_radius(self.maximum, self.wide) * self.shrinkage

    @property
    def corner(self) -> float:
        """Meters; a gathering ray shorter than this does not end the search."""
        return CORNER_RADII * self.wide * self.shrinkage

    @property
    def parameters(self) -> dict[str, float]:
        """Values of RADIUS_PARAMETERS."""
        return {
            "radius_scale": self.scale,
            "radius_minimum": self.minimum,
            "radius_maximum": self.maximum,
            "final_gather_radius": self.final_gather,
            "maximum_radius_factor": self.max_factor,
            "wide_radius": self.splats.wide,
            "gathers_again_below": self.corner,
        }

    @property
    def in_pixels(self) -> float:
        """Eq. 3's radius in the picture, pixels."""
        return self.scale / math.sqrt(math.pi) * self.shrinkage


def shrinkage(iteration: int, alpha: float) -> float:
    """r_i / r_1 of Eq. 2 for the iteration i >= 1: the product of sqrt((k + alpha) / (k + 1)), k < i."""
    k = np.arange(1, iteration)
    return float(np.exp(0.5 * np.sum(np.log((k + alpha) / (k + 1)))))


def shrinkage_in(dimensions: int, iteration: int, alpha: float) -> float:
    """Return the radius of a kernel of 1 or 3 dimensions in iteration i >= 1 over that of the first.

    The squared bias falls with r^4 and the variance with 1 / (i r^d): their sum falls fastest where r falls with
    i^(-1 / (d + 4)), which alpha = 2/3 gives in two dimensions (Kaplanyan and Dachsbacher 2013).
    """
    return shrinkage(iteration, alpha) ** (6.0 / (dimensions + 4.0))


def expected_photons(gathers: bool) -> int:
    """Global photons that the wide radius is to hold; ``gathers``: at the ends of gathering rays."""
    return EXPECTED_BY_GATHERING if gathers else EXPECTED_PHOTONS


def radius_in_pixels(settings: RenderSettings, camera: Camera) -> float:
    """s_r of Eq. 3 for this frame: the setting is for 1 megapixel and follows the frame's side."""
    return settings.radius_scale * math.sqrt(camera.width * camera.height / _REFERENCE_PIXELS)


def maximum_radius_factor(settings: RenderSettings) -> float:
    """Times Eq. 3's radius, what all pixels begin with for caustics (caustic_radii.py)."""
    exact = not settings.use_adaptive_radius or settings.radius_minimum > 0.0 or settings.radius_maximum > 0.0
    return 1.0 if exact else _MAX_FACTOR


def wide_radius(global_photons: int, expected: int, bounds_low: np.ndarray, bounds_high: np.ndarray) -> float:
    """Radius of the first iteration for photons that a diffuse surface has scattered, meters.

    Such light varies slowly, and its photons are spread over all of the scene: the disk holds
    the ``expected`` number of them where they lie evenly on surfaces as large as the bounds' six sides. Once photons
    have been seen, fitted_wide_radius follows them.
    """
    x, y, z = bounds_high - bounds_low
    area = 2.0 * (x * y + y * z + z * x)
    return math.sqrt(expected * area / (math.pi * max(global_photons, 1)))


def photons_found(counts: np.ndarray) -> float:
    """Photons that half of the view finds or more, of those that each pixel with an importon found, (n,).

    Where half of the view finds next to none, the mean is more representative than the median.
    """
    return max(float(np.median(counts)), 0.5 * float(np.mean(counts))) if len(counts) else 0.0


def photons_found_by_gathering(counts: np.ndarray) -> float:
    """Photons that half of the gathering rays find or more, of those that find any, from counts by pixel, (n,).

    Most rays may lead out of the scene, or to where no such light is: no radius would let them find photons, and the
    others would pay for it.
    """
    lit = counts[counts > 0]
    return float(np.median(lit)) if len(lit) else 0.0


def fitted_wide_radius(radius: float, expected: float, found: float) -> float:
    """The radius, meters, with which half of the view, or of the lit ends of gathering rays, would find ``expected``
    photons or more.

    Infinite if none are found. ``found`` is what photons_found or photons_found_by_gathering says of ``radius``.
    """
    return radius * math.sqrt(expected / found) if found > 0 else math.inf


def widest_radius(footprints: np.ndarray, bounds_low: np.ndarray, bounds_high: np.ndarray) -> float:
    """Return the upper limit of the wide radius of the first iteration, meters.

    A twentieth of the scene's diagonal, and ten times the Eq. 3 radius in the middle of the view (``footprints``, as
    for radius_limits): beyond, splats would cover the picture.
    """
    widest = 0.05 * float(np.linalg.norm(bounds_high - bounds_low))
    seen = _seen(footprints)
    return min(widest, 10.0 * float(np.median(seen))) if len(seen) else widest


def final_gather_radius(narrow: float, wide: float) -> float:
    """Radius, meters, for caustics at the ends of gathering rays, from r_max and the wide radius.

    They are bright and rare there, which a wider disk makes them less.
    """
    return min(max(narrow, wide), _MAX_CAUSTIC_RADII * narrow)


def _seen(footprints: np.ndarray) -> np.ndarray:
    return footprints[np.isfinite(footprints) & (footprints > 0)]


def radius_limits(settings: RenderSettings, footprints: np.ndarray, scene_radius: float) -> tuple[float, float]:
    """r_min and r_max of the first iteration, meters.

    ``footprints`` (rows, columns) are the Eq. 3 radii of the camera's first hits. Unset limits follow them:
    r_max, at which all photons are splatted, covers 95 % of the view, and r_min keeps a
    twentieth of the median where a hit lies at the camera's nose.
    """
    seen = _seen(footprints)
    middle, high = np.percentile(seen, [50, 95]) if len(seen) else (0.005 * scene_radius,) * 2
    maximum = settings.radius_maximum or min(float(high), 0.25 * scene_radius)
    minimum = settings.radius_minimum or min(0.05 * float(middle), maximum)
    return min(minimum, maximum), maximum
