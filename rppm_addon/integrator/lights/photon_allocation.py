# SPDX-License-Identifier: GPL-3.0-or-later
"""Allocation of an iteration's photons to lights (section 4.3 of the paper)."""

import numpy as np

from .portals import FIRST_PHOTON_FRACTION, photon_fraction
from .sources import photon_fractions


class PhotonAllocation:
    """Numbers of photons by light: by power, by the user's weights, and by what earlier photons contributed.

    The powers are those at the time when learning began: lights that move are allocated the same photons at all times,
    so that a render that is resumed allocates them likewise.
    """

    def __init__(self, powers: np.ndarray, weights: np.ndarray, has_portals: bool) -> None:
        """powers, weights: (n,) W and photon weights; has_portals: whether the last light is the part of the world's
        light that passes portals, and the one before it all of the world's."""
        self._powers, self._weights, self._has_portals = powers, weights, has_portals
        self.photon_count = 1
        """Photons of the iteration that is allocated last."""

    def allocate(
        self, photons: int, contributions: np.ndarray | None = None, portal_fraction: float = FIRST_PHOTON_FRACTION
    ) -> np.ndarray:
        """Return the numbers of photons, (n,) int64.

        contributions: (n,) contribution of a photon of each light, in any unit; None where nothing has been learned.
        portal_fraction: fraction of the world's photons that leave through portals, where there are any.
        """
        self.photon_count = photons
        powers = self._powers
        worth = self._weights if contributions is None else self._weights * contributions
        if self._has_portals:
            fractions = photon_fractions(powers[:-1], worth[:-1])
            world = fractions[-1] * np.array([1.0 - portal_fraction, portal_fraction])
            fractions = np.append(fractions[:-1], world)
        else:
            fractions = photon_fractions(powers, worth)
        return apportion(fractions, photons)

    def portal_fraction(self, contributions: np.ndarray) -> float:
        """Return the fraction of the world's photons that leave through portals, by contributions of lights, (n,)."""
        if not self._has_portals:
            return 0.0
        return photon_fraction(self._powers[-2:] * contributions[-2:])


def apportion(weights: np.ndarray, photons: int) -> np.ndarray:
    """Apportion photons by weights, (n,) int64 summing to ``photons``, by the largest remainders.

    A positive weight gets at least one photon while there are enough.
    """
    if len(weights) == 0 or weights.sum() <= 0:
        return np.zeros(len(weights), np.int64)
    exact = photons * (weights / weights.sum())
    counts = np.floor(exact).astype(np.int64)
    by_remainder = np.argsort(counts - exact, kind="stable")
    counts[by_remainder[: photons - counts.sum()]] += 1
    for index in np.nonzero((counts == 0) & (weights > 0))[0]:
        richest = np.argmax(counts)
        if counts[richest] > 1:
            counts[richest] -= 1
            counts[index] = 1
    return counts
