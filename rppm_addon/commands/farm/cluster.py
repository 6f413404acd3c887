# SPDX-License-Identifier: GPL-3.0-or-later
"""Workers of dask.distributed: of this machine, or those of a scheduler that runs somewhere."""

import contextlib
import logging
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import cryptography  # noqa: F401 (Security.temporary needs it, and says so too late)
import dask
import distributed
from distributed.security import Security

from .by_value import identity_function
from .errors import FarmError
from .identity import identity

log = logging.getLogger(__name__)

CONNECT_SECONDS = 20.0
_LOCAL = {
    "distributed.scheduler.http.routes": [],  # no web pages
    "distributed.worker.http.routes": [],
    "distributed.deploy.lost-worker-timeout": "20s",  # a worker that does not come back by itself is replaced then
}


@dataclass
class Cluster:
    """Workers that run the same RPPM as this process."""

    client: distributed.Client
    replace_lost: Callable[[], None] | None = None
    """Starts workers of this machine that did not come back by themselves; None where they are others' concern."""

    def __post_init__(self) -> None:
        self._identity = identity()
        self._known: dict[str, str] = {}
        """Identity of the RPPM that each worker runs, by the worker's address, or why the worker has none."""

    def workers(self) -> set[str]:
        """Addresses of the workers that are there now and may be given work."""
        there = set(self.client.scheduler_info()["workers"])
        if self.replace_lost is not None:
            self.replace_lost()
        new = sorted(there - self._known.keys())
        if new:
            answers = self.client.run(
                identity_function(local=self.replace_lost is not None), workers=new, on_error="return"
            )
            self._known.update({worker: str(answer) for worker, answer in answers.items()})
        return {worker for worker in there if self._known.get(worker) == self._identity}

    def refused(self) -> str:
        """Why workers were left out, in one line; empty when none was."""
        others = {worker: has for worker, has in self._known.items() if has != self._identity}
        if not others:
            return ""
        listed = ", ".join(f"{worker}: {has}" for worker, has in sorted(others.items()))
        return f"workers must run the same RPPM as the farm, {self._identity}; left out: {listed}"


@contextlib.contextmanager
def remote_cluster(address: str, debug: bool) -> Iterator[Cluster]:
    """The workers of a scheduler that runs already. Raises FarmError."""
    _log_level(debug)
    if is_open(address):
        log.warning("whoever reaches %s can run code on the farm as you; use TLS: docs/farm.md says how", address)
    try:
        client = distributed.Client(address, timeout=CONNECT_SECONDS)
    except (OSError, ValueError, TypeError, ImportError) as error:
        raise FarmError(
            f"no dask scheduler answers at {address} ({error}); start one with `dask scheduler` and give its address"
        ) from error
    with client:
        yield Cluster(client)


@contextlib.contextmanager
def local_cluster(devices: Sequence[str | None], allowed_failures: int, debug: bool) -> Iterator[Cluster]:
    """A worker for each of ``devices``: as RPPM_DEVICE takes them, or None for what RPPM chooses.

    Args:
        devices: one a worker.
        allowed_failures: how many workers a task may lose before it is given up.
        debug: show what the workers log.
    """
    level = _log_level(debug)
    security = Security.temporary()  # whoever can talk to a scheduler can run code: no other user of this machine may
    common = {"nthreads": 1, "memory_limit": 0, "host": "127.0.0.1", "security": security, "silence_logs": level}
    workers = {
        index: {
            "cls": distributed.Nanny,
            "options": common | {"env": {} if device is None else {"RPPM_DEVICE": device}},
        }
        for index, device in enumerate(devices)
    }
    scheduler = {
        "cls": distributed.Scheduler,
        "options": {
            "host": "127.0.0.1",
            "port": 0,
            "protocol": "tls://",
            "security": security,
            "dashboard": False,
            "dashboard_address": "127.0.0.1:0",
        },
    }
    with (
        dask.config.set(_LOCAL | {"distributed.scheduler.allowed-failures": allowed_failures}),
        distributed.SpecCluster(workers, scheduler, security=security, silence_logs=level) as cluster,
        distributed.Client(cluster, security=security) as client,
    ):
        yield Cluster(client, lambda: cluster.scale(len(devices)))


def is_open(address: str) -> bool:
    """Whether a scheduler's address is one that other machines reach without a key."""
    scheme, _, host = address.rpartition("://")
    name = host.rpartition(":")[0].strip("[]") or host
    return scheme in ("", "tcp") and name != "localhost" and not name.startswith("127.") and name != "::1"


def _log_level(debug: bool) -> int:
    """Have dask log what ``debug`` wants, and return that level: the farm reports to users itself."""
    level = logging.DEBUG if debug else logging.CRITICAL
    logging.getLogger("distributed").setLevel(level)
    logging.getLogger("distributed.client").setLevel(level)
    return level
