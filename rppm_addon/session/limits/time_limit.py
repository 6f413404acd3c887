# SPDX-License-Identifier: GPL-3.0-or-later
"""When a render with a time limit ends: with whole iterations, as near to the limit as these allow."""

import collections
import statistics

TOLERANCE = 0.05
"""Fraction of the time limit by which a render may end after it."""
_REMEMBERED = 3
"""Iterations whose median is expected of the next: one that was held up by other programs says nothing."""


class TimeLimit:
    """Says by the seconds of the iterations so far whether another one fits.

    All times are seconds since the render began.
    """

    def __init__(self, limit: float) -> None:
        """limit: seconds; 0 is none."""
        self.limit = limit
        self._seconds: collections.deque[float] = collections.deque(maxlen=_REMEMBERED)

    def add(self, seconds: float, photons: int, next_photons: int) -> None:
        """Record an iteration with so many photons; the next one has ``next_photons``."""
        # Measured in scenes of the usual kind, about half of an iteration's time goes with the number of its photons.
        self._seconds.append(seconds * (1.0 + next_photons / max(photons, 1)) / 2.0)

    @property
    def _expected(self) -> float:
        """Seconds that another iteration will take."""
        return statistics.median(self._seconds)

    @property
    def _latest(self) -> float:
        return self.limit * (1.0 + TOLERANCE)

    def allows_another(self, now: float) -> bool:
        """Whether another iteration is to be begun: it ends nearer to the limit than now, and not much later."""
        if self.limit <= 0.0 or not self._seconds:
            return True
        return now + self._expected <= min(self._latest, self.limit + 0.5 * self._expected)

    def may_cut(self, now: float) -> bool:
        """Whether an iteration that begins now is to be given up should it take longer than expected.

        The first one never is: there would be no picture, or a continued render would make no progress.
        """
        return self.limit > 0.0 and bool(self._seconds) and now + 2.0 * self._expected > self.limit

    def is_first_too_long(self, now: float) -> bool:
        """Whether an iteration that ends now, none being noted yet, is too late."""
        return self.limit > 0.0 and not self._seconds and self.has_passed(now)

    def has_passed(self, now: float) -> bool:
        """Whether an iteration under way is too late."""
        return now > self._latest
