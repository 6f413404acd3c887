# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of a farm at work, as the user sees it."""

import sys
import threading
import time

from ..terminal.progress_bar import ProgressBar
from .tasks import Task
from .worker import Outcome

_TASKS_SHOWN = 4


class Watch:
    """Counts tasks and says how far they are, where, and how long the rest will take."""

    def __init__(self, bar: ProgressBar, kind: str, total: int, done: int) -> None:
        """kind: of tasks, as in "frames"; total: all of the job; done: those found finished."""
        self._bar, self._kind, self._total, self._done = bar, kind, total, done
        self._found = done
        self._start = time.monotonic()
        self._running: dict[str, tuple[str, float, int]] = {}
        """Worker, fraction and number of frames by the task's name."""
        self._lock = threading.Lock()

    def on_event(self, event: tuple[float, dict]) -> None:
        """An event of the workers' topic; called by a thread of the client."""
        _, message = event
        with self._lock:
            self._running[message["task"]] = message["where"], message["fraction"], message["frames"]

    def on_end(self, task: Task, outcome: Outcome | None) -> None:
        """A task is over: how it went, None when it failed; frames of it may be done."""
        with self._lock:
            self._running.pop(task.name, None)
        if outcome is not None and outcome.rendered:
            self.say(f"{task.name}: {outcome.seconds:.1f} s on {outcome.worker}")
        undone = 0 if outcome is not None else len(task.rest.frames) or 1
        self._done += (len(task.frames) or 1) - undone

    def show(self) -> None:
        """Bring the bar up to date."""
        with self._lock:
            running = sorted(self._running.items())
        frames_under_way = [fraction * frames for _, (_, fraction, frames) in running]
        under_way = sum(frames_under_way)
        made, wanted = self._done - self._found + under_way, self._total - self._found
        words = f"{self._done + sum(map(int, frames_under_way))} of {self._total} {self._kind}"
        if made > 0.0:
            words += f", {_duration((time.monotonic() - self._start) * (wanted - made) / made)} to go"
        shown = [f"{name} on {worker} {fraction:.0%}" for name, (worker, fraction, _) in running[:_TASKS_SHOWN]]
        if len(running) > _TASKS_SHOWN:
            shown.append(f"{len(running) - _TASKS_SHOWN} more")
        self._bar.show((self._done + under_way) / self._total, "; ".join([words, *shown]))

    def say(self, line: str) -> None:
        """Print a line that stays."""
        self._bar.clear()
        print(line, flush=True)

    def warn(self, text: str) -> None:
        """Say what went wrong, on standard error."""
        self._bar.clear()
        sys.stderr.write(f"rppm: {text}\n")


def _duration(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{seconds:02d}"
