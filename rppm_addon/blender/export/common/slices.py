# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports in slices, between which Blender goes on: how long one takes, and what threads compute meanwhile."""

import math
import threading
import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any

SHORTEST_SECONDS, LONGEST_SECONDS = 0.03, 0.3
"""Lengths of slices between which Blender takes little time, and much."""
_SLICE_RATIO = 0.6
"""Ratio of a slice to the time that Blender takes between two: exports take up to three eighths of the time."""
FIRST_SECONDS, LONGEST_FIRST_SECONDS = 0.06, 0.12
"""The same, while there is no picture yet that somebody works with."""
_FIRST_RATIO = 1.5
"""The ratio of that time: first exports take up to three fifths of it."""
_MOST_STRETCH = 2.5
"""By how much a slice may last longer."""
_FRESH_SECONDS = 0.005
"""Oldest age of a slice, in seconds, at which a single long call still begins in it (step_alone)."""


@dataclass(frozen=True)
class ExportProgress:
    """Progress of an export in slices."""

    objects: int = 0
    of: int = 0
    """Number of all objects; 0 as long as there is more to be done before objects."""


class Unfinished(Exception):
    """The time of a slice is over. What was done is kept: who does the same again goes on from there."""


class SlicePacing:
    """Lengths of slices: the longer Blender takes between two of them, the longer they are.

    Redraws of a large scene may take half a second each. Slices that are short beside them would hardly shorten the
    time for which Blender does not answer, and would have the export wait for many more redraws. Slices of a viewport's
    first export are longer: somebody waits for its picture.
    """

    def __init__(self) -> None:
        self._ended_at: float | None = None

    def begin(self, is_first: bool = False) -> float:
        """Begin a slice and return its length, in seconds. is_first: it is part of a first export."""
        between = 0.0 if self._ended_at is None else time.monotonic() - self._ended_at
        shortest, longest, ratio = SHORTEST_SECONDS, LONGEST_SECONDS, _SLICE_RATIO
        if is_first:
            shortest, longest, ratio = FIRST_SECONDS, max(LONGEST_FIRST_SECONDS, ratio * between), _FIRST_RATIO
        return min(max(shortest, ratio * between), longest)

    def end(self, is_last: bool) -> None:
        """End a slice; what follows the last one of an export is not measured."""
        self._ended_at = None if is_last else time.monotonic()


class Slices:
    """The time of the slice that is under way. Without a beginning there is one, which never ends."""

    def __init__(self) -> None:
        self.begin(math.inf)

    def begin(self, seconds: float) -> None:
        """A slice of about so many seconds begins."""
        self._seconds = seconds
        self.restart()

    def restart(self) -> None:
        """Count from now on: what has gone before only found the place to go on from."""
        self._began, self._began_busy = time.monotonic(), time.thread_time()

    @property
    def is_over(self) -> bool:
        """Whether the time is over: on a machine busy with other things that of the processor counts, within bounds."""
        passed = time.monotonic() - self._began
        if passed < self._seconds:
            return False
        return passed >= _MOST_STRETCH * self._seconds or time.thread_time() - self._began_busy >= 0.5 * self._seconds

    @property
    def are_limited(self) -> bool:
        """Whether they end."""
        return not math.isinf(self._seconds)

    def rest(self) -> None:
        """To be called when something is done and kept. Raises Unfinished when the time is over."""
        if self.is_over:
            raise Unfinished

    def step(self, record: dict[Hashable, Any], name: Hashable, make: Callable[[], Any]) -> Any:
        """Return what ``make`` gives, made once and kept in a record by its name. May raise Unfinished then."""
        if name not in record:
            record[name] = make()
            self.rest()
        return record[name]

    def step_alone(self, record: dict[Hashable, Any], name: Hashable, make: Callable[[], Any]) -> Any:
        """As step(), for what Blender does in a single long call: it has a slice of its own."""
        waits = name, "waits"
        if self.are_limited and not {name, waits} & record.keys():
            record[waits] = True
            if time.monotonic() > self._began + _FRESH_SECONDS:
                raise Unfinished
        return self.step(record, name, make)

    def computed(self, record: dict[Hashable, Any], name: Hashable, compute: Callable[[], Any]) -> Any:
        """As step(), for what takes long and asks nothing of Blender: a thread computes it where time is limited.

        Raises Unfinished until it is done, or what ``compute`` raises.
        """
        if name not in record and not self.are_limited:
            record[name] = compute()
        # Waiting here, not in a loop of slices, leaves the processor to the thread.
        if not _is_done(record, name, compute, max(self._began + self._seconds - time.monotonic(), 0.0)):
            raise Unfinished
        return record[name]

    def computed_so_far(self, record: dict[Hashable, Any], name: Hashable, compute: Callable[[], Any]) -> Any:
        """As computed(), but None until it is done: the export goes on with something else meanwhile."""
        return record[name] if _is_done(record, name, compute, 0.0) else None


def _is_done(record: dict[Hashable, Any], name: Hashable, compute: Callable[[], Any], seconds: float) -> bool:
    """Have a thread compute what a record lacks, wait so long for it, and return whether the record has it now."""
    if name not in record:
        record[name] = _Job(compute)
    if isinstance(job := record[name], _Job):
        if not job.wait(seconds):
            return False
        del record[name]
        record[name] = job.result()
    return True


class _Job:
    """Something computed in a thread of its own, which nobody waits for at the end of Blender."""

    def __init__(self, compute: Callable[[], Any]) -> None:
        self._compute: Callable[[], Any] | None = compute
        self._result: Any = None
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="RPPM export", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            self._result = self._compute()
        except BaseException as error:
            self._error = error
        self._compute = None

    def wait(self, seconds: float) -> bool:
        """Whether it is done, at the latest after so many seconds."""
        self._thread.join(None if math.isinf(seconds) else seconds)
        return not self._thread.is_alive()

    def result(self) -> Any:
        """Return what was computed; raises what computing it raised."""
        if self._error is not None:
            raise self._error
        return self._result
