# SPDX-License-Identifier: GPL-3.0-or-later
"""Learning from iterations for later ones: how wide the radii have to be, and where photons are sent."""

import math
from dataclasses import dataclass

import numpy as np

from ..scene.meshes import RayVisibility
from ..scene.settings import DirectLight
from .common.iteration import Iteration
from .common.photon_counts import NoiseSamples, NoiseVariances, PhotonCounts, camera_cost, photon_cost
from .common.require import require
from .density_estimation.radii import (
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
from .density_estimation.stored_photons import PhotonList
from .device_scene.stage_context import StageContext
from .lights.lights import Lights
from .pilot_view import PilotView, at_pixels
from .stages.photons import Photons

_MOST_LEAVING = 0.25
"""Fraction of gathering rays that leave the scene, below which photons may share the world's direct light. Where more
leave, rays find that light as well as photons or better."""
_LEAST_UNCOVERED = 0.02
"""Least fraction of the gathering rays leaving the scene that pass no portal, for photons to share the world's direct
light. Where more rays pass portals, shadow rays find nearly all of that light there."""


_WEIGHED_AT = 64
"""The iteration with whose radii the noise of photons is weighed."""
_PHOTONS_OF_DISKS, _FEWEST_OF_DISKS = 0.25, 1 << 11
"""Photons a pixel, and at all, with which the wide radius holds the expected number: of fewer it holds fewer."""


@dataclass(frozen=True)
class BandFindings:
    """Findings about photons in a band, from an iteration that is learned from."""

    photons_taken: np.ndarray
    """(pixels, 2): SplatSums.photons_taken."""
    noise_samples: np.ndarray | None = None
    """PhotonNoise.sample, where the noise is weighed."""


def may_share_world_light(context: StageContext) -> bool:
    """Whether photons may bring a part of the world's direct light."""
    by_rays = context.settings.direct_light is DirectLight.RAYS and context.gathers
    return by_rays and context.lights.world_photon_flux > 0.0


class Learning:
    """The radii of a picture's iterations. They begin with what the pilot view shows."""

    def __init__(self, context: StageContext, pilot: PilotView) -> None:
        footprints = pilot.footprints
        settings, camera, geometry = context.settings, context.scene.camera, context.geometry
        self._geometry = geometry
        self._alpha = settings.alpha
        self._gathers = context.gathers
        self._expected = expected_photons(context.gathers)
        self._scale = radius_in_pixels(settings, camera)
        self._most_factor = maximum_radius_factor(settings)
        self._size = camera.resolution
        self.leaves_importon = footprints > 0
        """(rows, columns) of the pilot view."""
        self.limits = radius_limits(settings, footprints, geometry.radius)
        """r_min and r_max of the first iteration, meters."""
        self.widest_radius = widest_radius(footprints, geometry.bounds_low, geometry.bounds_high)
        self._automatic = settings.photons == 0
        self.photon_counts = PhotonCounts((context.scene.photon_count,))
        columns, rows = camera.resolution
        of_disks = max(_PHOTONS_OF_DISKS * columns * rows, _FEWEST_OF_DISKS)
        self._photons_of_disks = min(of_disks, context.scene.photon_count)
        self.photon_noise = NoiseVariances()
        self.rest: np.ndarray | None = None
        """(rows, columns) float32, where photons are automatic: luminance of samples of the last iteration that was
        learned from, without that of photons."""
        leaves_little = 0.0 < pilot.leaving_fraction < _MOST_LEAVING
        self._shares_world_light = leaves_little and pilot.uncovered_fraction >= _LEAST_UNCOVERED
        self.wide_radius = 0.0
        """Radius over which global photons are spread, meters, before it shrinks: that of the first iteration. Known
        once the photons of that iteration are."""
        self.global_photons_found: float | None = None
        """Result of photons_found, or photons_found_by_gathering, for the last iteration; None if no photons were
        counted."""

    def radii_for(self, iteration: Iteration, listed: PhotonList) -> Radii:
        """Radii of an iteration whose stored photons are known."""
        if iteration.number == 1:
            bounds = self._geometry.bounds_low, self._geometry.bounds_high
            self.wide_radius = min(wide_radius(listed.global_photon_count, self._expected, *bounds), self.widest_radius)
        return self.radii(iteration.number)

    def radii(self, number: int) -> Radii:
        """Return the radii of the iteration of this number, from 1, as far as they are known."""
        shrunk = shrinkage(number, self._alpha)
        return Radii(*self.limits, self.wide_radius, self._scale, self._most_factor, shrunk)

    def photon_fraction(self, iteration: Iteration) -> float:
        """Photons of an iteration over those of the first."""
        return iteration.photon_count / self.photon_counts.first

    def direct_world_flux(self, lights: Lights) -> float:
        """Iteration's, of the next one: where few rays leave the scene, photons find in, and all rays see the world."""
        shares = self._shares_world_light and lights.world_visibility == RayVisibility.ALL
        return lights.world_photon_flux if shares else 0.0

    def tally(
        self,
        context: StageContext,
        photons: Photons,
        findings: list[BandFindings],
    ) -> None:
        """Count which photons of an iteration contributed; ``findings``: by band, where it is learned from."""
        with context.timers.stage("learning"):
            context.lights.tally(photons.blocks, photons.slots)
            self.global_photons_found = None
            if findings:
                taken = np.concatenate([band.photons_taken for band in findings])
                counts = taken[at_pixels(self.leaves_importon, *self._size), 0]
                self.global_photons_found = (
                    photons_found_by_gathering(counts) if self._gathers else photons_found(counts)
                )

    @property
    def weighs_noise(self) -> bool:
        """Whether the number of photons follows the noise: without final gather all that is seen of light from other
        surfaces would be blotches of fewer photons."""
        return self._automatic and self._gathers

    def weigh_noise(
        self,
        iteration: Iteration,
        photons: Photons,
        vertices: int,
        findings: list[BandFindings],
    ) -> None:
        """Choose how many photons the iterations after one that is learned from have; ``vertices``: of its camera
        paths."""
        found = NoiseSamples.of(np.concatenate([require(band.noise_samples) for band in findings]))
        if self.rest is None:
            self.photon_noise = self.photon_noise.with_first(found)
        else:
            growth = (shrinkage(iteration.number, self._alpha) / shrinkage(_WEIGHED_AT, self._alpha)) ** 2
            self.photon_noise = self.photon_noise.with_next(iteration.photon_count, found, self.rest, growth)
        self.rest = found.rest.astype(np.float32)
        pairs = sum(int(band.photons_taken.sum(dtype=np.int64)) for band in findings)
        each = photon_cost(iteration.photon_count, photons.count_segments(), pairs)
        paths = camera_cost(vertices, iteration.shadow_rays)
        later = self.photon_noise.best_photons(self.photon_counts.first, each, paths)
        self.photon_counts = self.photon_counts.followed_by(later)

    def learn(self, context: StageContext, number: int) -> None:
        """Put to use what the iterations up to this number have tallied."""
        with context.timers.stage("learning"):
            gain = context.lights.learn(self.photon_counts.of(number + 1))
            shrunk = self.wide_radius * shrinkage(number, self._alpha)
            # Fewer photons make noise, which is weighed, and not wider disks, of which nobody would know the bias.
            expected = self._expected * min(self.photon_counts.of(number + 1) / self._photons_of_disks, 1.0)
            # Few photons make bold promises: the radius is at most halved before they are kept.
            fitted = fitted_wide_radius(shrunk, expected, require(self.global_photons_found))
            self.wide_radius = min(fitted / math.sqrt(min(gain, 4.0)), self.widest_radius)
            self.global_photons_found = None
