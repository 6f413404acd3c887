# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair-share scheduling of the device."""

from collections.abc import Hashable, Iterable


class FairShare:
    """Divides the device's time among sessions in proportion to their weights.

    Each session has a clock that its turns advance, the slower the greater its weight. The session whose clock is
    behind is next. A session that was idle starts where the others are, so idle time is not made up for.
    """

    def __init__(self) -> None:
        self._clocks: dict[Hashable, float] = {}
        self._waiting: set[Hashable] = set()
        self._now = 0.0

    def next(self, candidates: Iterable[Hashable]) -> Hashable | None:
        """Return which of the sessions that are not idle is next; None if all are."""
        candidates = list(candidates)
        for candidate in candidates:
            if candidate not in self._waiting:
                self._clocks[candidate] = max(self._clocks.get(candidate, 0.0), self._now)
        self._waiting = set(candidates)
        self._clocks = {key: clock for key, clock in self._clocks.items() if clock > self._now or key in self._waiting}
        if not candidates:
            return None
        chosen = min(candidates, key=self._clocks.__getitem__)
        self._now = self._clocks[chosen]
        return chosen

    def charge(self, candidate: Hashable, seconds: float, weight: float) -> None:
        """Advance the clock of a session whose turn has taken so many seconds."""
        self._clocks[candidate] += seconds / weight
