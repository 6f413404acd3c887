# SPDX-License-Identifier: GPL-3.0-or-later
"""State that later iterations depend on, beside scene, settings and their own numbers."""

from dataclasses import dataclass

import numpy as np

from ..scene.errors import CheckpointError
from .common.iteration import LEARNING_ITERATIONS
from .common.photon_counts import NoiseVariances, PhotonCounts
from .learning import Learning
from .lights.lights import Lights
from .stage_set import StageSet


@dataclass
class RenderState:
    """A render between two iterations: a mapper that takes the same scene and this goes on bit for bit."""

    skipped: int
    """Number of iterations before the first one of the film."""
    iteration: int
    """The last that was run, counted from 1: ``iteration - skipped`` are in the film. The radii follow (Eq. 2)."""
    photon_counts: PhotonCounts
    """Numbers of photons that have been chosen so far, where automatic."""
    photon_noise: NoiseVariances
    """Noise variances by which the number of photons of later iterations is chosen, where it is automatic."""
    wide_radius: float
    """Radius over which global photons are spread, meters, before it shrinks: that of the first iteration."""
    global_photons_found: float | None
    """Result of photons_found, or photons_found_by_gathering, for the last iteration; None if the next one does not
    learn from it."""
    radiance: np.ndarray
    """(height, width, 4) float32 mean of radiance W/(m^2 sr) and alpha, row 0 at the bottom, before exposure."""
    passes: dict[str, np.ndarray]
    """(height, width) or (height, width, channels) float32 by name (scene/passes.py)."""
    pass_counts: np.ndarray
    """(height, width, 2) uint32: iterations that the passes' means are of; and those that found a surface. (0, 0, 2)
    where there are no passes."""
    radius_factors: np.ndarray
    """(height, width) float32: times Eq. 3's radius, that for caustics of the iterations to come."""
    tallies: np.ndarray
    """(cells, 2) uint32 of the guide: photons that left through each cell, and those that contributed."""
    learned: np.ndarray | None
    """(cells, 2) uint32: the tallies by which cells are chosen; None while they are chosen evenly."""
    rest: np.ndarray | None
    """(rows, columns) float32 of some pixels: the luminance that came without photons in the last iteration that was
    learned from, while others are to be; None where photons are not automatic."""
    half: np.ndarray | None = None
    """(height, width, 3) float32: as radiance, that of half of the iterations (NoiseEstimate); None where the picture
    does not end with its noise."""

    @property
    def iterations_in_film(self) -> int:
        """Number of iterations in the film's means."""
        return self.iteration - self.skipped


def read_state(stages: StageSet, lights: Lights, learning: Learning, iteration: int, skipped: int) -> RenderState:
    """Return the state that iterations after this one depend on."""
    film = stages.film
    return RenderState(
        skipped=skipped,
        iteration=iteration,
        photon_counts=learning.photon_counts,
        photon_noise=learning.photon_noise,
        wide_radius=learning.radius_schedule.wide_radius,
        global_photons_found=learning.global_photons_found,
        radiance=film.read_radiance(),
        passes=film.read_passes(),
        pass_counts=film.read_pass_counts(),
        radius_factors=stages.caustic_radii.read(),
        tallies=lights.guide.read_tallies(),
        learned=lights.guide.learned,
        rest=learning.rest if iteration < LEARNING_ITERATIONS else None,
        half=stages.noise_estimate.read(),
    )


def restore_state(state: RenderState, stages: StageSet, lights: Lights, learning: Learning) -> None:
    """Go on from a state, before the first iteration.

    Raises CheckpointError when the state is none of this scene.
    """
    film = stages.film
    if state.radiance.shape[:2] != (film.height, film.width):
        raise CheckpointError(
            f"the checkpoint has {state.radiance.shape[1]}x{state.radiance.shape[0]} pixels, "
            f"not {film.width}x{film.height}; begin anew"
        )
    try:
        lights.restore(state.tallies, state.learned, state.photon_counts.of(state.iteration))
    except ValueError as error:
        raise CheckpointError(f"the checkpoint is none of this scene's: {error}; begin anew") from error
    try:
        film.restore(state.radiance, state.passes, state.pass_counts)
    except KeyError as error:
        raise CheckpointError(f"the checkpoint has no pass {error}; begin anew") from error
    if not stages.noise_estimate.restore(state.half):
        raise CheckpointError(
            "the checkpoint is of a render without a noise threshold; go on without one (use_adaptive_sampling) or "
            "begin anew"
        )
    if state.rest is None:
        if learning.weighs_noise and state.iteration < LEARNING_ITERATIONS:
            raise CheckpointError("the checkpoint lacks the noise of photons; begin anew")
    elif state.rest.shape != stages.photon_noise.shape:
        raise CheckpointError(f"the checkpoint has {state.rest.shape} samples of noise; begin anew")
    stages.caustic_radii.restore(state.radius_factors)
    learning.photon_counts, learning.photon_noise = state.photon_counts, state.photon_noise
    learning.rest = state.rest
    learning.radius_schedule.wide_radius = state.wide_radius
    learning.global_photons_found = state.global_photons_found
