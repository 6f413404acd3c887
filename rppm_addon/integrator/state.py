# SPDX-License-Identifier: GPL-3.0-or-later
"""What the iterations to come rest on, beside scene, settings and their own numbers."""

from dataclasses import dataclass

import numpy as np

from .photon_counts import PhotonCounts


@dataclass
class RenderState:
    """A render between two iterations: a mapper that takes the same scene and this goes on bit for bit."""

    left_out: int
    """So many iterations come before those of the film."""
    iteration: int
    """The last that was run, counted from 1: ``iteration - left_out`` are in the film. The radii follow (Eq. 2)."""
    photon_counts: PhotonCounts
    """Where automatic, known once the first iteration has been."""
    wide_radius: float
    """Of the first iteration, metres: what diffused photons are spread over."""
    diffused_photons_found: float | None
    """What photons_found, or photons_found_by_ray, says of the last iteration, if the next one learns from it."""
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
    """(cells, 2) uint32 of the guide: photons that left through each cell, and those that were of use."""
    learnt: np.ndarray | None
    """(cells, 2) uint32: the tallies by which cells are chosen; None while they are chosen evenly."""

    @property
    def iterations_in_film(self) -> int:
        return self.iteration - self.left_out
