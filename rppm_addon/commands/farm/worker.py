# SPDX-License-Identifier: GPL-3.0-or-later
"""Execution of a task on a worker: one call of rppm in a process of its own, and its pictures put in place."""

import contextlib
import os
import platform
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import distributed

import rppm_addon

from ...scene.errors import SettingsError
from .errors import TaskError
from .ledger import ATTEMPT
from .tasks import Task
from .watchdog import TIMEOUT_SECONDS

TOPIC = "rppm-farm"
"""Topic of the events that report the progress of a task: task, where, fraction, frames."""
_POLL_SECONDS = 0.2
_LAST_LINES = 20
_FLAGS = 0
"""Creation flags of the program's process; there are none except on Windows."""
if sys.platform == "win32":
    _FLAGS = subprocess.CREATE_NEW_PROCESS_GROUP
_at_work = 0
_lock = threading.Lock()
_PROGRESS = re.compile(r"\s*(\d+)% ")


@dataclass(frozen=True)
class Outcome:
    """How a task went."""

    worker: str
    seconds: float
    rendered: bool
    """False when its pictures were there already."""


def perform(task: Task, folder: Path) -> Outcome:
    """Do a task but for what is done: its pictures are made in a folder of their own and moved when they are whole.

    Args:
        task: what to do.
        folder: of the ledger, on the file system of the pictures.

    Raises:
        TaskError: the program failed, or the task is no longer wanted.
    """
    worker = distributed.get_worker()
    label = f"{platform.node()}:{worker.name}"
    try:
        task.check(folder)
    except SettingsError as error:
        raise TaskError(str(error), label) from error
    if task.done:
        return Outcome(label, 0.0, False)

    def report(fraction: float) -> None:
        frames = len(task.frames) or 1
        worker.log_event(TOPIC, {"task": task.name, "where": label, "fraction": fraction, "frames": frames})

    report(0.0)
    start = time.perf_counter()
    with _counted():
        try:
            failure = _make_pictures(task.rest, folder, lambda: _wanted(worker), report)
        except OSError as error:
            failure = f"{error}; all machines must see the pictures at the same path and may write there"
    if failure:
        raise TaskError(failure, label)
    return Outcome(label, time.perf_counter() - start, True)


def tasks_at_work() -> int:
    """How many tasks this process is at."""
    return _at_work


@contextlib.contextmanager
def _counted() -> Iterator[None]:
    global _at_work
    with _lock:
        _at_work += 1
    try:
        yield
    finally:
        with _lock:
            _at_work -= 1


def _make_pictures(task: Task, folder: Path, wanted: Callable[[], bool], report: Callable[[float], None]) -> str:
    """Why not all pictures are there; empty when they are. Raises OSError."""
    with tempfile.TemporaryDirectory(prefix=ATTEMPT, dir=folder, ignore_cleanup_errors=True) as attempt:
        with _Program(task.command([Path(attempt) / path.name for path in task.outputs]), report) as program:
            while program.running:
                if not wanted():
                    return "stopped"
                if task.frames:  # of these the program writes whole ones only, of parts also what was interrupted
                    put_in_place(task, Path(attempt))
        if task.frames or not program.failure:
            put_in_place(task, Path(attempt))
    return program.failure


def put_in_place(task: Task, attempt: Path) -> None:
    """Move the pictures that are there to where they belong, first those of further view layers and views, which have
    files of their own beside the others'."""
    expected = {path.name: path for path in task.files}
    for made in sorted(attempt.glob("[!.]*"), key=lambda made: made.name in expected):
        beside = (path for path in task.files if path.suffix == made.suffix and made.stem.startswith(f"{path.stem}_"))
        place = expected.get(made.name) or next((path.with_name(made.name) for path in beside), None)
        if place is not None and made.is_file():
            made.replace(place)


class _Program:
    """The rppm program, watched; ends with the context."""

    def __init__(self, arguments: list[str], on_progress: Callable[[float], None]) -> None:
        root = str(Path(rppm_addon.__file__).resolve().parent.parent)
        paths = [root, *filter(None, [os.environ.get("PYTHONPATH")])]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "rppm_addon.watched", *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            env=os.environ | {"PYTHONPATH": os.pathsep.join(paths)},
            # Ctrl-C at the farm's terminal is for the farm.
            start_new_session=True,
            creationflags=_FLAGS,
        )
        self._lines: deque[str] = deque(maxlen=_LAST_LINES)
        self._on_progress = on_progress
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def __enter__(self) -> "_Program":
        return self

    def __exit__(self, *_: object) -> None:
        self._process.stdin.close()  # its watchdog ends it
        try:
            self._process.wait(2 * TIMEOUT_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._reader.join()
        self._process.stderr.close()

    @property
    def running(self) -> bool:
        """Whether it has not ended yet; waits a moment for that."""
        try:
            self._process.wait(_POLL_SECONDS)
        except subprocess.TimeoutExpired:
            return True
        return False

    @property
    def failure(self) -> str:
        """Why there are no pictures; empty when all went well."""
        status = self._process.returncode
        if status == 0:
            return ""
        messages = [line.removeprefix("rppm: ") for line in self._lines if line.startswith("rppm: ")]
        frames = [line for line in messages if line.startswith("frame ")]
        if messages and status > 0:
            return "\n".join(frames or messages[-1:])
        how = f"exit status {status}"
        if status < 0:
            how = f"ended by {signal.Signals(-status).name}"
        return "\n".join([how, *self._lines])

    def _read(self) -> None:
        for line in self._process.stderr:
            progress = _PROGRESS.match(line)
            if progress is None:
                self._lines.append(line.rstrip())
            else:
                self._on_progress(int(progress[1]) / 100.0)


def _wanted(worker: distributed.Worker) -> bool:
    """Whether the farm still waits for the task that this thread is at: it may have been stopped or killed."""
    state = worker.state.tasks.get(worker.get_current_task())
    return state is not None and state.state != "cancelled"
