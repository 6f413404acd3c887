# SPDX-License-Identifier: GPL-3.0-or-later
"""Learning from iterations for later ones: how wide the radii have to be, and where photons are sent."""

from dataclasses import dataclass

import numpy as np

from .common.iteration import Iteration
from .common.photon_counts import NoiseSamples, NoiseVariances, PhotonCounts, camera_cost, photon_cost
from .common.require import require
from .density_estimation.radii import Radii
from .density_estimation.radius_schedule import RadiusSchedule
from .density_estimation.stored_photons import PhotonList
from .device_scene.stage_context import StageContext
from .photons.photons import Photons
from .pilot_view import at_pixels

_WEIGHED_AT = 64
"""The iteration with whose radii the noise of photons is weighed."""


@dataclass(frozen=True)
class BandFindings:
    """Findings about photons in a band, from an iteration that is learned from."""

    photons_taken: np.ndarray
    """(pixels, 2): SplatSums.photons_taken."""
    noise_samples: np.ndarray | None = None
    """PhotonNoise.sample, where the noise is weighed."""


class Learning:
    """Radii and photons of a picture's iterations. Those of the first follow from the pilot view."""

    def __init__(self, context: StageContext, footprints: np.ndarray) -> None:
        """Begin with what the pilot view found.

        Args:
            context: context of the stages, with the scene.
            footprints: (rows, columns) Eq. 3 radii of the pilot view, meters; 0 where there is no importon.
        """
        settings, camera = context.settings, context.scene.camera
        self.leaves_importon = footprints > 0
        """(rows, columns) of the pilot view."""
        self.radius_schedule = RadiusSchedule(
            settings, camera, context.geometry, footprints, context.scene.photon_count, context.gathers
        )
        self._size = camera.resolution
        self.weighs_noise = settings.photons == 0 and context.gathers
        """Whether the number of photons follows the noise. Without final gather, all that is seen of light from other
        surfaces would be blotches of fewer photons."""
        self.photon_counts = PhotonCounts((context.scene.photon_count,))
        self.photon_noise = NoiseVariances()
        self.rest: np.ndarray | None = None
        """(rows, columns) float32, where photons are automatic: luminance of samples of the last iteration that was
        learned from, without that of photons."""
        self.global_photons_found: float | None = None
        """Result of RadiusSchedule.photons_found for the last iteration; None if no photons were counted."""

    def radii_for(self, iteration: Iteration, listed: PhotonList) -> Radii:
        """Radii of an iteration whose stored photons are known."""
        if iteration.number == 1:
            self.radius_schedule.begin(listed.global_photon_count)
        return self.radius_schedule.radii(iteration.number)

    def photon_fraction(self, iteration: Iteration) -> float:
        """Photons of an iteration over those of the first."""
        return iteration.photon_count / self.photon_counts.first

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
                self.global_photons_found = self.radius_schedule.photons_found(counts)

    def weigh_noise(
        self,
        iteration: Iteration,
        photons: Photons,
        vertices: int,
        findings: list[BandFindings],
        pairs_in_media: tuple[int, int],
    ) -> None:
        """Choose how many photons the iterations after one that is learned from have.

        Args:
            iteration: that one.
            photons: its photons.
            vertices: of its camera paths.
            findings: by band.
            pairs_in_media: how many photons, and how many photon beams, pixels took from media.
        """
        found = NoiseSamples.of(np.concatenate([require(band.noise_samples) for band in findings]))
        if self.rest is None:
            self.photon_noise = self.photon_noise.with_first(found)
        else:
            shrinkage = self.radius_schedule.shrinkage
            growth = (shrinkage(iteration.number) / shrinkage(_WEIGHED_AT)) ** 2
            self.photon_noise = self.photon_noise.with_next(iteration.photon_count, found, self.rest, growth)
        self.rest = found.rest.astype(np.float32)
        pairs = sum(int(band.photons_taken.sum(dtype=np.int64)) for band in findings)
        points, beams = pairs_in_media
        each = photon_cost(iteration.photon_count, photons.count_segments(), pairs + points, beams)
        paths = camera_cost(vertices, iteration.shadow_rays)
        later = self.photon_noise.best_photons(self.photon_counts.first, each, paths)
        self.photon_counts = self.photon_counts.followed_by(later)

    def learn(self, context: StageContext, number: int) -> None:
        """Adapt the guide and the radii to what the iterations up to this number have tallied."""
        with context.timers.stage("learning"):
            photon_count = self.photon_counts.of(number + 1)
            gain = context.lights.learn(photon_count)
            self.radius_schedule.fit(number, require(self.global_photons_found), photon_count, gain)
            self.global_photons_found = None
