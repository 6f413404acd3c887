# SPDX-License-Identifier: GPL-3.0-or-later
"""Description of an iteration that all of its stages receive."""

from dataclasses import dataclass

LEARNING_ITERATIONS = 16
"""Iterations from which later ones learn: given the seed, all later ones depend on these only."""


def learns_after(number: int) -> bool:
    """Whether the guide learns from the tallies of all iterations so far after iteration ``number``: 1, 2, 4, ..."""
    return number <= LEARNING_ITERATIONS and number & (number - 1) == 0


@dataclass(frozen=True)
class Iteration:
    """One iteration of Algorithm 1, as it is known before it begins."""

    number: int
    """i of Eq. 2, from 1; 0 is the pilot view."""
    seed: int
    photon_count: int = 0
    """Photons that leave the lights; none for the pilot view."""
    skipped: int = 0
    """Number of iterations before the first one of the film."""
    shadow_rays: int = 1
    """Shadow rays of each vertex of a camera path."""
    weighs_noise: bool = False
    """Whether the noise of photons is measured apart from other noise, to choose later numbers of photons by it."""
    film_count: int | None = None
    """``number_in_film`` of bands of rows that a rolling shutter exposes in some iterations only; None: of others."""

    @property
    def number_in_film(self) -> int:
        """From 1, among those of the film; 0 before them."""
        if self.film_count is not None:
            return self.film_count
        return max(self.number - self.skipped, 0)

    @property
    def enters_film(self) -> bool:
        """Whether what the iteration finds is added to the film."""
        return self.number_in_film > 0

    @property
    def precedes_learning(self) -> bool:
        """Whether the photons that pixels take are counted, for the next iteration to learn from."""
        return learns_after(self.number)

    @property
    def needs_radiance(self) -> bool:
        """Whether the film or the choice of the number of photons reads the radiance of pixels."""
        return self.enters_film or self.weighs_noise

    @property
    def is_tallied(self) -> bool:
        """Whether photons that contributed are counted."""
        return self.number <= LEARNING_ITERATIONS

    @property
    def roulette_seed(self) -> int:
        """Odd, so never 0, and another one for each iteration and seed."""
        return (2 * (self.number + 0x9E3779B1 * self.seed) + 1) % (1 << 32)
