# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that would keep a device for long is given to it in pieces.

Drivers reset a device that one dispatch or draw keeps for seconds, and nobody else can use it meanwhile: windows do not
move. How long a program takes is measured as it runs. What would take too long is cut into ranges of groups or
vertices, which are waited for one after the other. Pictures do not depend on where the cuts are.
"""

import ctypes
import functools
import time
from collections.abc import Callable
from dataclasses import dataclass

from .context import Context

LONGEST_SECONDS = 0.2
"""Seconds that one piece may keep the device."""
LONGEST_SECONDS_BESIDE_WINDOW = 0.015
"""The same, while somebody works in a window that the device draws."""
_AIM = 0.5
"""Fraction of the longest time that a piece is to take: items differ in what they cost."""
_FIRST_ITEMS = 64
"""Items of the first piece of a program whose speed is not known."""
_FEWEST_ITEMS = 16
"""Fewer would leave parts of a device idle."""
_FORGETTING = 0.97
_TIMESTAMP, _QUERY_RESULT, _QUERY_RESULT_AVAILABLE = 0x8E28, 0x8866, 0x8867


@dataclass
class Pace:
    """Speed of a program so far."""

    seconds_per_item: float | None = None
    """None where nothing is known."""
    max_seconds: float = 0.0
    """Seconds that all items together took, the longest lately."""
    epoch: int = 0
    """Count of the calls to Pacing.forget at the program's last run."""
    stopwatch: "_Stopwatch | None" = None

    def learn(self, items: int | None, seconds: float) -> None:
        """So many items, where that is known, took so long. The speed of few says nothing of that of many: most of
        their time is that of any dispatch."""
        self.max_seconds = max(seconds, _FORGETTING * self.max_seconds)
        if items and (items >= _FIRST_ITEMS or self.seconds_per_item is None):
            self.seconds_per_item = seconds / items


class Pacing:
    """Gives a device its work, in pieces where it would be kept for too long."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._flush = context.function("glFlush", None)
        self._unflushed = 0.0
        """Seconds that what the device was given since it last began will take."""
        self._epoch = 0
        self.max_seconds = LONGEST_SECONDS
        """Seconds that one piece may keep the device; share_with_window sets it."""
        self.pieces = 0
        """Pieces that work was cut into, so far."""

    def share_with_window(self, shares: bool) -> None:
        """Whether somebody works in a window meanwhile, which waits for the device unless that is the processor."""
        waits = shares and not self._context.is_software
        self.max_seconds = LONGEST_SECONDS_BESIDE_WINDOW if waits else LONGEST_SECONDS

    def forget(self) -> None:
        """Measure speeds anew, as what comes may take longer than what has been measured."""
        self._epoch += 1

    def run(
        self, pace: Pace, items: Callable[[], int], whole: Callable[[], None], part: Callable[[int, int], None]
    ) -> None:
        """Have a program run.

        Args:
            pace: the program's own.
            items: returns how many there are, for which the device may have to be waited for.
            whole: gives the device all of them.
            part: gives it those from a first one on, so many.
        """
        if pace.epoch != self._epoch:
            pace.epoch, pace.seconds_per_item = self._epoch, None
        if self._is_waited_for:
            count = items()
            if pace.seconds_per_item is not None and count * pace.seconds_per_item <= self._aim:
                pace.learn(count, self._seconds_of(whole))
            else:
                self._run_parts(pace, count, part)
        elif self._is_quick(pace):
            self._run_unwatched(pace, whole)
        else:
            self._run_parts(pace, items(), part)

    @property
    def _is_waited_for(self) -> bool:
        """Whether the device has always done what it was given: then counts and times cost nothing."""
        return self._context.is_software

    @property
    def _aim(self) -> float:
        return _AIM * self.max_seconds

    def _seconds_of(self, work: Callable[[], None]) -> float:
        """Run work and return the seconds that it takes the device, which has nothing else to do."""
        start = time.perf_counter()
        work()
        self._context.finish()
        return time.perf_counter() - start

    def _run_parts(self, pace: Pace, count: int, part: Callable[[int, int], None]) -> None:
        done, total, size, rate = 0, 0.0, _FIRST_ITEMS, pace.seconds_per_item
        if rate is not None:
            size = self._affordable(rate)
        self._context.finish()
        self._unflushed = 0.0
        while done < count:
            items = min(size, count - done)
            seconds = self._seconds_of(functools.partial(part, done, items))
            self.pieces += items < count
            done, total, rate = done + items, total + seconds, seconds / items
            size = min(2 * size, self._affordable(rate))
        if count:
            pace.learn(None, total)
            pace.seconds_per_item = rate

    def _affordable(self, rate: float) -> int:
        """Items for which there is time, each taking so many seconds."""
        return max(int(self._aim / max(rate, 1e-12)), _FEWEST_ITEMS)

    def _is_quick(self, pace: Pace) -> bool:
        """Whether all of a program's items have taken no longer than they may, of late."""
        seconds = pace.stopwatch.seconds if pace.stopwatch is not None else None
        if seconds is not None:
            pace.learn(None, seconds)
            if seconds > self._aim:  # of how many items is not known
                pace.seconds_per_item = None
        return pace.seconds_per_item is not None and pace.max_seconds <= self._aim

    def _run_unwatched(self, pace: Pace, whole: Callable[[], None]) -> None:
        """Without waiting for the device; what it took is looked up later."""
        pace.stopwatch = pace.stopwatch or _Stopwatch(self._context)
        if pace.stopwatch.is_running:
            whole()
        else:
            pace.stopwatch.start()
            whole()
            pace.stopwatch.stop()
        self._unflushed += pace.max_seconds
        if self._unflushed > self._aim:
            self._flush()
            self._unflushed = 0.0


class _Stopwatch:
    """Seconds from one command to another, by the device's own clock. Stages' timers may run meanwhile."""

    def __init__(self, context: Context) -> None:
        unsigned, number = ctypes.c_uint, ctypes.POINTER(ctypes.c_uint64)
        self._queries = (unsigned * 2)()
        context.function("glGenQueries", None, ctypes.c_int, ctypes.POINTER(unsigned))(2, self._queries)
        self._note = context.function("glQueryCounter", None, unsigned, unsigned)
        self._read = context.function("glGetQueryObjectui64v", None, unsigned, unsigned, number)
        self.is_running = False
        """Whether the device has not come to its end."""

    def start(self) -> None:
        """From here."""
        self._note(self._queries[0], _TIMESTAMP)

    def stop(self) -> None:
        """To here."""
        self._note(self._queries[1], _TIMESTAMP)
        self.is_running = True

    @property
    def seconds(self) -> float | None:
        """Seconds from start to stop, returned once: None after that, and until the device has come to their end."""
        if not self.is_running or not self._value(1, _QUERY_RESULT_AVAILABLE):
            return None
        self.is_running = False
        return 1e-9 * (self._value(1, _QUERY_RESULT) - self._value(0, _QUERY_RESULT))

    def _value(self, query: int, name: int) -> int:
        value = ctypes.c_uint64(0)
        self._read(self._queries[query], name, ctypes.byref(value))
        return value.value
