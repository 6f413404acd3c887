# SPDX-License-Identifier: GPL-3.0-or-later
"""The radii of a picture's iterations: from the pilot view, and by the photons that pixels have found."""

import math

import numpy as np

from ...scene.camera import Camera
from ...scene.settings import RenderSettings
from ..surfaces.geometry import Geometry
from .radii import (
    Radii,
    expected_photons,
    fitted_wide_radius,
    maximum_radius_factor,
    photons_found,
    photons_found_by_gathering,
    radius_in_pixels,
    radius_limits,
    shrinkage,
    wide_radius,
    widest_radius,
)

_PHOTONS_OF_DISKS, _FEWEST_OF_DISKS = 0.25, 1 << 11
"""Photons per pixel, and at least in all, with which the wide radius holds the expected number of photons. With fewer
photons, it is fitted to proportionally fewer."""
_MOST_GAIN = 4.0
"""Largest gain of the guide by which the wide radius is narrowed at once: few photons overestimate it."""


class RadiusSchedule:
    """Radii of the iterations of one picture."""

    def __init__(
        self,
        settings: RenderSettings,
        camera: Camera,
        geometry: Geometry,
        footprints: np.ndarray,
        photon_count: int,
        gathers: bool,
    ) -> None:
        """Choose the radii of the first iteration.

        Args:
            settings: settings of the scene.
            camera: camera of the scene.
            geometry: the scene's geometry on the device.
            footprints: (rows, columns) Eq. 3 radii of the pilot view, meters.
            photon_count: photons of the first iteration.
            gathers: whether gathering rays find the photons, and not the camera's view.
        """
        self._geometry = geometry
        self._gathers = gathers
        self._alpha = settings.alpha
        self._scale = radius_in_pixels(settings, camera)
        self._most_factor = maximum_radius_factor(settings)
        self._expected = expected_photons(self._gathers)
        columns, rows = camera.resolution
        self._photons_of_disks = min(max(_PHOTONS_OF_DISKS * columns * rows, _FEWEST_OF_DISKS), photon_count)
        self.limits = radius_limits(settings, footprints, geometry.radius)
        """r_min and r_max of the first iteration, meters."""
        self.widest_radius = widest_radius(footprints, geometry.bounds_low, geometry.bounds_high)
        """Upper limit of the wide radius, meters."""
        self.wide_radius = 0.0
        """Radius over which global photons are spread, meters, before it shrinks: that of the first iteration. Known
        once the photons of that iteration are."""

    def begin(self, global_photon_count: int) -> None:
        """Choose the wide radius of the first iteration by the number of its global photons."""
        bounds = self._geometry.bounds_low, self._geometry.bounds_high
        self.wide_radius = min(wide_radius(global_photon_count, self._expected, *bounds), self.widest_radius)

    def radii(self, number: int) -> Radii:
        """Return the radii of the iteration of this number, from 1, as far as they are known."""
        return Radii(*self.limits, self.wide_radius, self._scale, self._most_factor, self.shrinkage(number))

    def shrinkage(self, number: int) -> float:
        """Return the radii of the iteration of this number over those of the first (Eq. 2)."""
        return shrinkage(number, self._alpha)

    def photons_found(self, counts: np.ndarray) -> float:
        """Return the global photons that half of the view, or of its gathering rays, finds; counts: (n,) by pixel."""
        return photons_found_by_gathering(counts) if self._gathers else photons_found(counts)

    def fit(self, number: int, found: float, photon_count: int, gain: float) -> None:
        """Fit the wide radius to the photons that an iteration has found.

        Args:
            number: number of the iteration, from 1.
            found: result of photons_found.
            photon_count: photons of the next iteration.
            gain: how many times more photons contribute in the next iteration, as the guide has learned.
        """
        shrunk = self.wide_radius * self.shrinkage(number)
        # Fewer photons make noise, which is weighed, and not wider disks, of which nobody would know the bias.
        expected = self._expected * min(photon_count / self._photons_of_disks, 1.0)
        fitted = fitted_wide_radius(shrunk, expected, found)
        self.wide_radius = min(fitted / math.sqrt(min(gain, _MOST_GAIN)), self.widest_radius)
