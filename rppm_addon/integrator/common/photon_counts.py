# SPDX-License-Identifier: GPL-3.0-or-later
"""How many photons the iterations have, which follows what they are the noise of."""

from dataclasses import dataclass

import numpy as np

_FOR_PHOTONS_ALONE = 2.0
_LEAST_PER_PIXEL, _FEWEST = 0.25, 1 << 11
_OF_USE = 1e-3
"""Share of a light's photons in the first iteration: where more contributed, all of them count."""


def photons_of_use(by_light: np.ndarray) -> tuple[float, float]:
    """Photons of the first iteration, and the caustic ones among them, that importons might take, of lights that shine
    on what the camera sees.

    by_light: (n, 3) of each light's photons those that importons might take, the diffused ones among them, and those
    that contributed. Lights of which next to none did, such as lamps in other rooms, count by as much less.
    """
    listed, diffused, contributed = by_light.astype(np.float64).T
    if not contributed.any():
        return float(listed.sum()), float((listed - diffused).sum())
    weights = np.minimum(contributed / np.maximum(_OF_USE * listed, 1.0), 1.0)
    return float(weights @ listed), float(weights @ (listed - diffused))


def later_photons(first: int, pixels: int, by_photons: float, listed: float) -> int:
    """Photons of each iteration after the first, where automatic, from how many photons of the first one importons
    might take, and how many of these show light that no ray looks for: caustic ones, or all without final gather.

    The noise of gathering and shadow rays is not lessened by more photons. What was measured is in
    docs/benchmarks/iterations.md.
    """
    fraction = by_photons / listed if listed else 0.0
    wanted = round(pixels * min(max(_FOR_PHOTONS_ALONE * fraction, _LEAST_PER_PIXEL), 1.0))
    return min(first, max(wanted, _FEWEST))


@dataclass(frozen=True)
class PhotonCounts:
    """Photons of the first iteration, and of each later one, which are no more."""

    first: int
    later: int

    def of(self, iteration: int) -> int:
        """Photons of an iteration, counted from 1."""
        return self.later if iteration > 1 else self.first

    def emitted(self, skipped: int, iterations: int) -> int:
        """In so many iterations after those skipped."""
        has_first = skipped == 0 and iterations > 0
        return iterations * self.later + (self.first - self.later if has_first else 0)
