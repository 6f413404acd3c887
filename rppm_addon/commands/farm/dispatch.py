# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives tasks to workers until all are done or have failed."""

import contextlib
import dataclasses
import time
from collections import Counter, deque
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass

import distributed
from distributed.comm import CommClosedError

from .by_value import perform_function
from .cluster import Cluster
from .errors import FarmError, TaskError
from .ledger import Ledger
from .tasks import Task
from .watch import Watch
from .worker import TOPIC, tasks_at_work

_POLL_SECONDS = 0.5
_WORKER_SECONDS = 60.0
"""So long without any worker is an error."""
_STOP_SECONDS = 30.0


class Dispatcher:
    """Keeps one task on each worker, in the tasks' order.

    The scheduler moves tasks of lost workers to others and tries failed ones again. No more tasks are with it than
    there are workers: it counts the loss of a worker against all tasks that it had meant for it.
    """

    def __init__(self, cluster: Cluster, ledger: Ledger, retries: int, should_stop: Callable[[], bool]) -> None:
        self._cluster, self._ledger, self._retries, self._should_stop = cluster, ledger, retries, should_stop
        self._client = cluster.client
        self._running: dict[distributed.Future, _Assignment] = {}
        self._losses: Counter[Task] = Counter()
        """How often all workers were lost that a task was meant for: the scheduler counts other losses."""
        self._reported = ""

    def run(self, tasks: Sequence[Task], watch: Watch) -> list[Task]:
        """Do tasks and return what failed of them; their errors are reported when they come.

        Raises FarmError when the scheduler or all workers are gone. Returns early when asked to stop.
        """
        waiting, failed = deque(tasks), []
        self._client.subscribe_topic(TOPIC, watch.on_event)
        seen = time.monotonic()
        try:
            while (waiting or self._running) and not self._should_stop():
                workers = self._cluster.workers()
                self._warn(watch)
                if workers:
                    seen = time.monotonic()
                elif time.monotonic() - seen > _WORKER_SECONDS:
                    raise FarmError(f"no worker for {_WORKER_SECONDS:.0f} s. {self._cluster.refused()}".rstrip())
                for task in self._stranded(workers):
                    self._losses[task] += 1
                    if self._losses[task] <= self._retries:
                        waiting.appendleft(task)
                    else:
                        failed.append(task.rest)
                        watch.on_end(task, None)
                        self._tell_loss(task.rest, self._losses[task], watch)
                while waiting and len(self._running) < len(workers):
                    self._submit(waiting.popleft(), workers)
                failed += self._collect(watch)
                watch.show()
        except (CancelledError, CommClosedError, OSError) as error:
            raise FarmError(
                f"the scheduler is lost ({error}); finished pictures lie there: run the same again to go on"
            ) from error
        finally:
            self._stop()
        return failed

    def _submit(self, task: Task, workers: set[str]) -> None:
        future = self._client.submit(
            perform_function(),
            self._ledger.folder,
            workers=sorted(workers),
            retries=self._retries,
            pure=False,
            key=f"rppm {task.name} {time.time_ns():x}",
            **{field.name: getattr(task, field.name) for field in dataclasses.fields(task)},
        )
        self._running[future] = _Assignment(task, frozenset(workers))

    def _stranded(self, workers: set[str]) -> list[Task]:
        """Take back tasks of which no worker is left that they were meant for: others have come in their place."""
        stranded = [future for future, assignment in self._running.items() if not assignment.workers & workers]
        stranded = [future for future in stranded if not future.done()]
        if stranded:
            self._client.cancel(stranded)
        return [self._running.pop(future).task for future in stranded]

    def _collect(self, watch: Watch) -> list[Task]:
        """Wait a little for tasks to end; returns those that failed."""
        if not self._running:
            time.sleep(_POLL_SECONDS)
            return []
        try:
            ended = distributed.wait(list(self._running), timeout=_POLL_SECONDS, return_when="FIRST_COMPLETED").done
        except TimeoutError:
            return []
        failed = []
        for future in ended:
            task = self._running.pop(future).task
            error = future.exception()
            watch.on_end(task, None if error else future.result())
            if error is not None:
                failed.append(task.rest)
                self._tell(task.rest, error, watch)
        return failed

    def _tell(self, task: Task, error: BaseException, watch: Watch) -> None:
        if isinstance(error, distributed.KilledWorker):
            self._tell_loss(task, error.allowed_failures + 1, watch)
            return
        where = f" on {error.worker}" if isinstance(error, TaskError) else ""
        watch.warn(f"{task.name} failed{where}: {error}\n  {task.command_line}")

    def _tell_loss(self, task: Task, losses: int, watch: Watch) -> None:
        watch.warn(f"{task.name} failed: its worker was lost {losses} times\n  {task.command_line}")

    def _warn(self, watch: Watch) -> None:
        refused = self._cluster.refused()
        if refused and refused != self._reported:
            watch.warn(refused)
            self._reported = refused

    def _stop(self) -> None:
        """Let go of what is still at work, and wait until it has tidied up."""
        if self._running:
            with contextlib.suppress(CancelledError, CommClosedError, OSError):  # of a lost scheduler
                self._client.cancel(list(self._running))
                give_up = time.monotonic() + _STOP_SECONDS
                while self._at_work() and time.monotonic() < give_up:
                    time.sleep(0.1)
        self._ledger.remove_attempts()

    def _at_work(self) -> bool:
        workers = sorted(self._cluster.workers())
        return any(self._client.run(tasks_at_work, workers=workers, on_error="ignore").values())


@dataclass(frozen=True)
class _Assignment:
    task: Task
    workers: frozenset[str]
    """Addresses of those that may do it."""
