# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds spent in each stage."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from .context import Context


class StageTimers:
    """Sums device seconds by stage name.

    On a GPU these are GL timer queries, read when they are asked for. On a software driver such
    queries measure nothing (the work runs elsewhere), so the stage is finished and ``clock`` read, a
    function that returns seconds. Stages do not nest.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self.clock: Callable[[], float] = time.perf_counter
        self._seconds: dict[str, float] = {}
        self._pending: list[tuple[str, Any]] = []
        self._idle: list[Any] = []

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time the device work given within the with block."""
        if self._context.is_software:
            start = self.clock()
            yield
            self._context.finish()
            self._seconds[name] = self._seconds.get(name, 0.0) + self.clock() - start
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
