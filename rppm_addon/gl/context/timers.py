# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds spent in each stage."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from .context import Context


class StageTimers:
    """Sums device seconds by stage name, once somebody has asked for them.

    Queries are read in time, which waits for the device, and stages are waited for one by one: renders of which nobody
    looks at the seconds go without.

    On a GPU these are GL timer queries, read when they are asked for. On a software driver such
    queries measure nothing (the work runs elsewhere), so the stage is finished and a clock read, a
    function that returns seconds. Stages do not nest.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._clock: Callable[[], float] | None = None
        self._seconds: dict[str, float] = {}
        self._pending: list[tuple[str, Any]] = []
        self._idle: list[Any] = []

    def begin(self, clock: Callable[[], float] = time.perf_counter) -> None:
        """Time stages from now on, on a software driver by a clock."""
        self._clock = clock

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time the device work given within the with block."""
        if self._clock is None:
            yield
            return
        if self._context.is_software:
            start = self._clock()
            yield
            self._context.finish()
            self._seconds[name] = self._seconds.get(name, 0.0) + self._clock() - start
            return
        query = self._idle.pop() if self._idle else self._context.moderngl.query(time=True)
        with query:
            yield
        self._pending.append((name, query))
        if len(self._pending) >= 512:
            self._collect()

    def _collect(self) -> None:
        for name, query in self._pending:
            self._seconds[name] = self._seconds.get(name, 0.0) + query.elapsed * 1e-9
            self._idle.append(query)  # moderngl cannot delete queries: they are used again
        self._pending.clear()

    @property
    def seconds(self) -> dict[str, float]:
        """Seconds so far by stage."""
        self._collect()
        return dict(self._seconds)

    def reset(self) -> None:
        """Count from 0 again."""
        self._collect()
        self._seconds.clear()
