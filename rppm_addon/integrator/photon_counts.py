# SPDX-License-Identifier: GPL-3.0-or-later
"""How many photons the iterations have, which follows what they are the noise of."""

from dataclasses import dataclass

_BY_CAUSTICS = 2.0
_LEAST_PER_PIXEL, _FEWEST = 0.25, 1 << 11


def later_photons(first: int, pixels: int, caustic: int, listed: int) -> int:
    """Photons of each iteration after the first, where automatic, from how many photons of the first one importons
    might take, and how many of these are caustic ones.

    Caustics are seen by photons alone; other light comes along gathering and shadow rays, whose noise more photons do
    not lessen. What was measured is in docs/benchmarks/iterations.md.
    """
    share = caustic / listed if listed else 0.0
    wanted = round(pixels * min(max(_BY_CAUSTICS * share, _LEAST_PER_PIXEL), 1.0))
    return min(first, max(wanted, _FEWEST))


@dataclass(frozen=True)
class PhotonCounts:
    """Photons of the first iteration, and of each later one, which are no more."""

    first: int
    later: int

    def of(self, iteration: int) -> int:
        """Photons of an iteration, counted from 1."""
        return self.later if iteration > 1 else self.first

    def emitted(self, left_out: int, iterations: int) -> int:
        """In so many iterations after those left out."""
        return iterations * self.later + (self.first - self.later if left_out == 0 < iterations else 0)
