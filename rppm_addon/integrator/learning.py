# SPDX-License-Identifier: GPL-3.0-or-later
"""What iterations learn for those that come: how wide the radii have to be, and where photons are sent."""

import math

import numpy as np

from ..scene.meshes import RayVisibility
from ..scene.settings import DirectLight
from .common.iteration import Iteration
from .common.known import known
from .common.photon_counts import PhotonCounts, later_photons, photons_of_use
from .density_estimation.radii import (
    Radii,
    expected_photons,
    fitted_wide_radius,
    most_radius_factor,
    photons_found,
    photons_found_by_ray,
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
"""Of gathering rays: where more leave the scene, rays find the world's light as well as photons or better."""
_LEAST_UNCOVERED = 0.02
"""Of those that leave: where more pass portals, shadow rays find nearly all of it there."""


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
        self._by_ray = context.gathers
        self._expected = expected_photons(context.gathers)
        self._scale = radius_in_pixels(settings, camera)
        self._most_factor = most_radius_factor(settings)
        self._size = camera.resolution
        self.leaves_importon = footprints > 0
        """(rows, columns) of the pilot view."""
        self.limits = radius_limits(settings, footprints, geometry.radius)
        """r_min and r_max of the first iteration, meters."""
        self.widest_radius = widest_radius(footprints, geometry.bounds_low, geometry.bounds_high)
        self._automatic = settings.photons == 0
        self.photon_counts = PhotonCounts(context.scene.photon_count, context.scene.photon_count)
        leaves_little = 0.0 < pilot.leaving_fraction < _MOST_LEAVING
        self._shares_world_light = leaves_little and pilot.uncovered_fraction >= _LEAST_UNCOVERED
        self.wide_radius = 0.0
        """Of the first iteration, meters: what diffused photons are spread over. Known once its photons are."""
        self.diffused_photons_found: float | None = None
        """What photons_found, or photons_found_by_ray, says of the last iteration, if they were counted."""

    def radii_for(self, iteration: Iteration, listed: PhotonList) -> Radii:
        """Radii of an iteration whose stored photons are known. The first one's say how many later ones have, until
        tally knows which lights these are of."""
        if iteration.number == 1:
            self._count_later_photons(listed.count, listed.count - listed.diffused_count)
            bounds = self._geometry.bounds_low, self._geometry.bounds_high
            self.wide_radius = min(wide_radius(listed.diffused_count, self._expected, *bounds), self.widest_radius)
        return self.radii(iteration.number)

    def _count_later_photons(self, listed: float, caustic: float) -> None:
        """Follow the photons of the first iteration that importons might take, and the caustic ones among them."""
        if self._automatic:
            first, (columns, rows) = self.photon_counts.first, self._size
            later = later_photons(first, columns * rows, caustic if self._by_ray else listed, listed)
            self.photon_counts = PhotonCounts(first, later)

    def radii(self, number: int) -> Radii:
        """Those of the iteration of this number, from 1, as far as it is known."""
        shrunk = shrinkage(number, self._alpha)
        return Radii(*self.limits, self.wide_radius, self._scale, self._most_factor, shrunk)

    def fewer(self, iteration: Iteration) -> float:
        """Photons of the next iteration over those of this one."""
        return self.photon_counts.of(iteration.number + 1) / iteration.photon_count

    def direct_world_flux(self, lights: Lights) -> float:
        """Iteration's, of the next one: where few rays leave the scene, photons find in, and all rays see the world."""
        shares = self._shares_world_light and lights.world_visibility == RayVisibility.ALL
        return lights.world_photon_flux if shares else 0.0

    def tally(
        self,
        context: StageContext,
        photons: Photons,
        listed: PhotonList,
        iteration: Iteration,
        photons_taken: list[np.ndarray],
    ) -> None:
        """Count which photons of an iteration contributed, and how many diffused ones pixels took, by band. Those of
        the first say how many later ones have, as far as lights differ in what they are good for."""
        with context.timers.stage("learning"):
            context.lights.tally(photons.stored_blocks, photons.slots)
            light_count = len(context.lights.table)
            if iteration.number == 1 and self._automatic and self._by_ray and listed.count and light_count > 1:
                lights = context.lights.buffers["Lights"]
                by_light = listed.by_light(photons.photons.buffer, lights, light_count)
                self._count_later_photons(*photons_of_use(by_light))
            self.diffused_photons_found = None
            if photons_taken:
                counts = np.concatenate(photons_taken)[at_pixels(self.leaves_importon, *self._size)]
                self.diffused_photons_found = photons_found_by_ray(counts) if self._by_ray else photons_found(counts)

    def learn(self, context: StageContext, number: int) -> None:
        """Put to use what the iterations up to this number have tallied."""
        with context.timers.stage("learning"):
            gain = context.lights.learn(self.photon_counts.of(number + 1))
            shrunk = self.wide_radius * shrinkage(number, self._alpha)
            # Few photons make bold promises: the radius is at most halved before they are kept.
            fitted = fitted_wide_radius(shrunk, self._expected, known(self.diffused_photons_found))
            self.wide_radius = min(fitted / math.sqrt(min(gain, 4.0)), self.widest_radius)
            self.diffused_photons_found = None
