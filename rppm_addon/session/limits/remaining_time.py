# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a render will still take."""

from ...integrator.common.iteration import LEARNING_ITERATIONS


class RemainingTime:
    """Expects of the iterations to come what the later half of those so far took: the first ones wait for programs and
    have other numbers of photons."""

    def __init__(self) -> None:
        self._ends: list[float] = []

    def add(self, now: float) -> None:
        """An iteration of this render has ended, ``now`` seconds after its begin."""
        self._ends.append(now)

    def seconds(self, iterations: int, now: float, time_limit: float) -> float | None:
        """Until so many more iterations are done or the time limit (0 is none) has passed; None before the first."""
        if not self._ends:
            return time_limit - now if time_limit > 0.0 else None
        last = len(self._ends) - 1
        first = max(last // 2, last - 4 * LEARNING_ITERATIONS)
        each = (self._ends[last] - self._ends[first]) / (last - first) if last > first else self._ends[0]
        remaining = max(iterations, 0) * each
        return max(min(remaining, time_limit - now), 0.0) if time_limit > 0.0 else remaining
