# SPDX-License-Identifier: GPL-3.0-or-later
"""One run of rppm farm: what was asked for, the pictures that are missing, the workers, and how it ended."""

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...scene.errors import SceneError
from ..terminal.progress_bar import ProgressBar
from .cluster import Cluster, local_cluster, remote_cluster
from .dispatch import Dispatcher
from .identity import identity
from .ledger import Ledger
from .tasks import Task, chunks, frame_tasks, still_tasks
from .watch import Watch


@dataclass
class FarmRequest:
    """Request of the command line for a farm. Paths are absolute: every machine finds the same file there."""

    file: Path
    outputs: list[Path]
    options: list[str]
    """Options of rppm render, the same in every task that renders."""
    frames: Sequence[int] = ()
    """Frame numbers of an animation; empty for a still."""
    iterations: int = 0
    """Iterations of a still, all parts together."""
    parts: int = 0
    chunk: int = 1
    """Frames that one start of Blender renders."""
    scheduler: str | None = None
    """Address; None starts workers here."""
    devices: Sequence[str | None] = (None,)
    """Devices of the workers on this machine, one each."""
    retries: int = 0
    overwrite: bool = False


@dataclass(frozen=True)
class FarmReport:
    """How a farm went; counts are of frames or parts."""

    kind: str
    """Unit of the counts: "frames" or "parts"."""
    total: int
    found: int
    """There, and whole, before."""
    failed: list[str]
    """Names of the frames or parts that failed."""
    finished: bool
    """Whether all pictures are there."""


def run_farm(request: FarmRequest, bar: ProgressBar, should_stop: Callable[[], bool], debug: bool) -> FarmReport:
    """Make the pictures that are missing. Raises RppmError."""
    ledger = Ledger(request.outputs[0])
    tasks, merge = _tasks(request, ledger)
    every = [*tasks, merge] if merge else tasks
    bar.show(0.0, "looking for pictures that are there")
    missing = ledger.open(_job(request), every, request.overwrite)
    if merge and merge not in missing:
        missing = []  # the parts are gone, the picture is there
    missing_tasks = [task for task in missing if task is not merge]
    found = len(tasks) - len(missing_tasks)
    kind = "parts" if merge else "frames"
    watch = Watch(bar, kind, len(tasks), found)
    if found:
        watch.say(f"{found} of {len(tasks)} {kind} are there and whole")
    failed: list[Task] = []
    finished = not missing
    if missing:
        bar.show(0.0, "looking for workers")
        with _cluster(request, debug) as cluster:
            dispatcher = Dispatcher(cluster, ledger, request.retries, should_stop)
            failed = dispatcher.run(missing_tasks if merge else chunks(missing_tasks, request.chunk), watch)
            if merge and not failed and not should_stop():
                failed = dispatcher.run([merge], Watch(bar, "pictures", 1, 0))
            finished = not failed and not should_stop()
    if merge and finished:
        ledger.remove_parts()
    names = [single.name for task in failed for single in task.singles]
    return FarmReport(kind, len(tasks), found, names, finished)


def _tasks(request: FarmRequest, ledger: Ledger) -> tuple[list[Task], Task | None]:
    """The tasks of all frames, or of a still's parts and the one that merges them."""
    if request.frames:
        return frame_tasks(request.file, request.frames, request.outputs, request.options), None
    return still_tasks(request.file, request.iterations, request.parts, request.outputs, ledger.folder, request.options)


def _job(request: FarmRequest) -> dict[str, object]:
    """All that the pictures depend on, as JSON has it. Frames do not depend on which others are asked for."""
    try:
        status = request.file.stat()
    except OSError as error:
        raise SceneError(f"{request.file} does not exist; give the path of a .blend file or saved scene") from error
    return {
        "scene": [str(request.file), status.st_size, status.st_mtime_ns],
        "options": list(request.options),
        "split": None if request.frames else [request.iterations, request.parts],
        "RPPM": identity(),
    }


def _cluster(request: FarmRequest, debug: bool) -> contextlib.AbstractContextManager[Cluster]:
    if request.scheduler is not None:
        return remote_cluster(request.scheduler, debug)
    return local_cluster(request.devices, request.retries, debug)
