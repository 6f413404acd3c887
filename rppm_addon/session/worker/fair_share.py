# SPDX-License-Identifier: GPL-3.0-or-later
"""Whose turn it is on the device."""

from collections.abc import Hashable, Iterable


class FairShare:
    """Gives turns so that those who want the device share its time by their weights.

    Each has a clock that its turns advance, the slower the greater the weight; the one whose clock is behind is next.
    Who comes back after a pause starts where the others are: time that was not wanted is not owed.
    """

    def __init__(self) -> None:
        self._clocks: dict[Hashable, float] = {}
        self._waiting: set[Hashable] = set()
        self._now = 0.0

    def next(self, candidates: Iterable[Hashable]) -> Hashable | None:
        """Who is next of those that want the device; None when nobody does."""
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

    def took(self, candidate: Hashable, seconds: float, weight: float) -> None:
        """The turn of ``candidate`` has taken so long."""
        self._clocks[candidate] += seconds / weight
