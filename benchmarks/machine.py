# SPDX-License-Identifier: GPL-3.0-or-later
"""Machine that a benchmark ran on, and the clock that means something there."""

import datetime
import platform
import re
import statistics
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import moderngl
import numpy as np

from rppm_addon.gl.context.context import Context
from rppm_addon.processors import usable_cores

from . import ROOT


class Clock:
    """Measures work of the device and of the host in seconds.

    On a software driver the device is the processor: the time that all threads took together, divided by
    the cores, stays the same when other programs run beside it. On GPUs it is the wall clock.
    """

    def __init__(self, context: Context, quick: bool = False) -> None:
        self._context = context
        self._quick = quick
        self.cores = usable_cores()
        self.is_software = context.is_software
        self.description = (
            f"process time of all threads / {self.cores} cores" if self.is_software else "wall clock between finishes"
        )

    def now(self) -> float:
        """Seconds since some moment."""
        return time.process_time() / self.cores if self.is_software else time.perf_counter()

    def once(self, work: Callable[[], object]) -> float:
        """Seconds of one call, until the device is done."""
        self._context.finish()
        start = self.now()
        work()
        self._context.finish()
        return self.now() - start

    def median(self, work: Callable[[], object]) -> float:
        """Median of several calls: as many as fit a third of a second, 2 to 5 on software and 5 to 50 on GPUs.

        One call is enough where it lasts more than a second.
        """
        least, most = (2, 5) if self.is_software else (5, 50)
        if self._quick:
            least, most = (1, 3) if self.is_software else (3, 10)
        seconds: list[float] = []
        while sum(seconds) < 0.3 and len(seconds) < most or sum(seconds) < 1.0 and len(seconds) < least:
            seconds.append(self.once(work))
        return statistics.median(seconds)

    def host(self, work: Callable[[], object], threads: int) -> float:
        """Seconds of one call that keeps ``threads`` threads of the host busy."""
        start = time.process_time() if self.is_software else time.perf_counter()
        work()
        if self.is_software:
            return (time.process_time() - start) / threads
        return time.perf_counter() - start


def describe(context: Context, clock: Clock, commit: str | None = None) -> dict[str, object]:
    """Device, host, versions, commit and date, as plain values."""
    information = context.information
    return {
        "device": information.name,
        "driver": information.driver,
        "opengl": information.version,
        "software_driver": context.is_software,
        "moderngl": moderngl.__version__,
        "numpy": np.__version__,
        "clock": clock.description,
    } | describe_host(commit)


def describe_host(commit: str | None = None) -> dict[str, object]:
    """Processor, system, Python, commit and date, as plain values."""
    return {
        "processor": processor_name(),
        "cores": usable_cores(),
        "system": platform.platform(),
        "python": platform.python_version(),
        "commit": commit or checkout_commit(),
        "date": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
    }


def slug(machine: dict[str, object]) -> str:
    """A folder's name for a machine: its device, and its processor where that is the device."""
    name = re.sub(r"\(.*?\)|/.*", " ", str(machine["device"]))
    if machine["software_driver"]:
        processor = re.sub(r"\(.*?\)|\b(CPU|Processor)\b|@.*", " ", str(machine["processor"]))
        name = f"{name} {processor} {machine['cores']} cores"
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or "device"


def processor_name() -> str:
    """The processor's name, without the padding that some makers add."""
    try:
        found = re.search(r"^model name\s*:\s*(.+)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    except OSError:
        found = None
    name = found.group(1) if found else platform.processor() or platform.machine()
    return " ".join(name.split())


def checkout_commit() -> str:
    """The checkout's commit; with + where tracked files other than figures differ from it."""

    def git(*arguments: str) -> str:
        command = ["git", *arguments]
        return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()

    try:
        changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/benchmarks")
        return git("rev-parse", "--short=10", "HEAD") + ("+" if changed else "")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
