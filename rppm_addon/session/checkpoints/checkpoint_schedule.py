# SPDX-License-Identifier: GPL-3.0-or-later
"""When a render hands over its state: for its checkpoint, and to continue after a lost device."""

import time
from collections.abc import Callable

from .continuation import Continuation, Pause

FIRST_SAFEGUARD_SECONDS = 0.25
"""Seconds until the first safeguard of a render. A render that takes less is quickly done again."""
SAFEGUARD_SECONDS = 5.0
"""Least time from one safeguard of a render to the next. A lost device loses the iterations between them."""
SAFEGUARD_MOST_TIME = 0.02
"""Largest fraction of all time that safeguards may take."""


class CheckpointSchedule:
    """Calls the callbacks of a continuation in time."""

    def __init__(self, continuation: Continuation, read_pause: Callable[[], Pause | None]) -> None:
        """read_pause: returns the state between two iterations; None during an iteration and before the first."""
        self._continuation = continuation
        self._read_pause = read_pause
        self._kept_at = time.perf_counter()
        self._safeguard_due = self._kept_at + FIRST_SAFEGUARD_SECONDS

    def keep(self) -> None:
        """Hand over the state for the checkpoint, if the render has one and its film has an iteration."""
        if self._continuation.keep is not None and (pause := self._read_pause()) is not None:
            self._continuation.keep(pause)
        self._kept_at = time.perf_counter()

    def run(self, elapsed: float) -> None:
        """Hand over the state where it is due after an iteration; ``elapsed``: seconds since the render began."""
        if time.perf_counter() - self._kept_at >= self._continuation.interval:
            self.keep()
        start = time.perf_counter()
        if self._continuation.safeguard is None or start < self._safeguard_due:
            return
        if (pause := self._read_pause()) is not None:
            self._continuation.safeguard(pause, elapsed)
        now = time.perf_counter()
        self._safeguard_due = now + max(SAFEGUARD_SECONDS, (now - start) / SAFEGUARD_MOST_TIME)
