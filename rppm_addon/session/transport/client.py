# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer's process for whoever shows what it renders. No call waits for it but close()."""

import collections
import contextlib
import enum
import logging
import os
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from ...denoising.places import LibraryPlace
from ...gl.context.context import DeviceInformation
from ...gl.context.devices import Device
from ...scene.scene import Scene
from .child_process import ChildProcess
from .client_session import PreparationSession, RenderSession, Session, ViewportSession
from .connection import Connection
from .sessions import SessionKind

logger = logging.getLogger(__name__)

LARGEST_LOG = 1 << 24
"""Bytes; then the log begins anew."""
_UNASKED = {SessionKind.PREVIEW, SessionKind.PREPARATION}
"""Kinds of sessions that are opened without a request of the user."""
_AnySession = TypeVar("_AnySession", bound=Session)
MOST_RESTARTS = 2
"""Times that a process which died is started anew without being asked to."""


class ProcessState(enum.Enum):
    """Whether there is a renderer process."""

    STOPPED = "STOPPED"
    """It is started when a session is opened."""
    STARTING = "STARTING"
    RUNNING = "RUNNING"
    FAILED = "FAILED"
    """It ended too often or cannot run here; ``error`` says why. restart() and new sessions but previews try again."""


@dataclass(frozen=True)
class Timeouts:
    """How long to wait for the process, seconds."""

    start: float = 60.0
    """Until it has opened the device; the first start after an installation reads much from the disk."""
    answer: float = 300.0
    """Until it answers a ping. It does so between two pieces of work; compiling a large material is one."""
    leave: float = 1.5
    """Until it has left when it was asked to."""
    ping: float = 2.0
    """Between two pings."""


class RendererProcess:
    """Owns the process: starts it when it is first needed, starts it anew when it dies, and ends it.

    A thread of its own, the keeper, starts and ends processes; with each process come a thread that writes and one
    that reads. What they share is guarded by ``changed``, which is never held while anything waits.
    """

    def __init__(
        self,
        python: Sequence[str],
        folders: Sequence[str],
        log_path: Path,
        timeouts: Timeouts | None = None,
        denoisers: Sequence[LibraryPlace] = (),
    ) -> None:
        """No process is started yet.

        Args:
            python: the program that runs Python, and its options.
            folders: where that Python finds NumPy and moderngl, if not by itself.
            log_path: the file that takes what the process logs; earlier contents are dropped.
            timeouts: how long to wait for what.
            denoisers: libraries in the order in which they are tried.
        """
        self.state = ProcessState.STOPPED
        self.error = ""
        """Why the process ended last, one line; empty while all is well."""
        self.device: DeviceInformation | None = None
        self.is_listing = False
        """Whether more will be known of the other devices."""
        self.log_path = log_path
        self.restarts = 0
        self.changed = threading.Condition()
        self._python = list(python)
        self._folders = list(folders)
        self._timeouts = timeouts or Timeouts()
        self.denoisers = list(denoisers)
        """Denoiser libraries that the next process is told of when it starts."""
        self.environment: dict[str, str] = {}
        """Variables that it has beside Blender's own."""
        self.sessions: dict[int, Session] = {}
        self._numbers = 0
        self.outbox: collections.deque[tuple[str, dict]] = collections.deque()
        self._keeper: threading.Thread | None = None
        self._leaving = False
        self._restarting = False

    def open(self, kind: SessionKind) -> ViewportSession | RenderSession:
        """A new session for pictures; starts the process if there is none.

        After a failure a viewport or a final render, which users ask for, tries again; previews come by themselves.
        """
        if kind is SessionKind.VIEWPORT:
            return self._open(ViewportSession, kind)
        return self._open(RenderSession, kind)

    def prepare(self, scene: Scene) -> None:
        """Have the programs for a scene compiled before anybody waits for them; starts the process if there is none.

        Only the settings and the materials' graphs count. After a failure nothing is done.
        """
        self._open(PreparationSession, SessionKind.PREPARATION).show(scene, 1, False)

    def _open(self, made: type[_AnySession], kind: SessionKind) -> _AnySession:
        with self.changed:
            self._numbers += 1
            session = made(self, self._numbers, kind)
            self.sessions[self._numbers] = session
            if self.state is ProcessState.RUNNING:
                session.introduce()
            elif self.state is ProcessState.FAILED and kind in _UNASKED:
                session.fail(self.error)
            elif self.state in {ProcessState.STOPPED, ProcessState.FAILED}:
                self._start()
            return session

    def restart(self, lists_devices: bool = False) -> None:
        """End the process if there is one, and start a new one that takes over the open sessions.

        lists_devices: have it open each device for a moment; until it has, ``is_listing`` is set.
        """
        with self.changed:
            self.is_listing = lists_devices
            if self._keeper is None:
                self._start()
            else:
                self.restarts, self.error = 0, ""
                self._restarting = True
                self.state = ProcessState.STARTING
                self.changed.notify_all()

    def close(self) -> None:
        """End the process and all sessions. Waits for it, but a few seconds at the most."""
        with self.changed:
            self._end_sessions()
            keeper = self._keeper
            self._leaving = True
            self.changed.notify_all()
        if keeper is not None:
            keeper.join(self._timeouts.leave + 5.0)
        with self.changed:
            self._leaving = False
            self.outbox.clear()
            self.state, self.error, self.restarts = ProcessState.STOPPED, "", 0

    # For sessions and the connection, with ``changed`` held.

    def post(self, kind: str, **content: object) -> None:
        """Have a message sent to the process, if there is one; a new one gets all that it must know."""
        if self.state is ProcessState.RUNNING:
            self.outbox.append((kind, content))
            self.changed.notify_all()

    def greeted(self, device: DeviceInformation) -> None:
        """A process has opened the device: tell it of the sessions."""
        self.device = device
        self.state = ProcessState.RUNNING
        self.outbox.clear()
        for session in self.sessions.values():
            session.introduce()
        self.is_listing &= len(device.devices) > 1
        if self.is_listing:
            self.outbox.append(("list_devices", {}))
        self.changed.notify_all()

    def devices_listed(self, devices: list[Device]) -> None:
        """A process has opened each device."""
        self.is_listing = False
        if self.device is not None:
            self.device.devices = devices

    def close_session(self, session: Session) -> None:
        """Forget a session."""
        with self.changed:
            if self.sessions.pop(session.number, None) is not None:
                session.release()
                self.post("close", session=session.number)

    def _end_sessions(self) -> None:
        for session in self.sessions.values():
            session.fail("The renderer process was closed")
            session.release()
        self.sessions.clear()

    def _start(self) -> None:
        self.state, self.restarts, self.error = ProcessState.STARTING, 0, ""
        # A daemon: a Blender that ends without unregistering must not wait for it.
        self._keeper = threading.Thread(target=self._keep, name="RPPM process", daemon=True)
        self._keeper.start()

    # In the keeper's thread.

    def _keep(self) -> None:
        self._begin_log()
        while True:
            reason, again = self._run_process()
            if reason:
                logger.warning("%s", reason)  # not where Blender could wait for it
            with self.changed:
                self.device = None
                self.is_listing &= self._restarting  # what a driver ends is not asked for again
                if self._leaving:
                    self._end_sessions()
                    self.state, self._keeper = ProcessState.STOPPED, None
                    return
                self.state = ProcessState.STARTING
                if self._restarting:
                    self._restarting = False
                    continue
                self.error = f"{reason}; its log is {self.log_path}"
                if not again or self.restarts >= MOST_RESTARTS:
                    self.state, self._keeper = ProcessState.FAILED, None
                    for session in self.sessions.values():
                        session.fail(self.error)
                    return
                self.restarts += 1

    def _begin_log(self) -> None:
        try:
            self.log_path.parent.mkdir(parents=True, exist_ok=True)
            self.log_path.write_bytes(b"")
        except OSError as error:
            logger.warning("the log cannot be written: %s", error)

    def _limit_log(self) -> None:
        """A driver that complains all the time must not fill the disk; the process appends, so it can go on."""
        with contextlib.suppress(OSError):
            if self.log_path.stat().st_size > LARGEST_LOG:
                os.truncate(self.log_path, 0)

    def _run_process(self) -> tuple[str, bool]:
        """Start a process and see to it until it ends: why it did, and whether another one may do better."""
        try:
            child = ChildProcess(self._python, self._folders, self.log_path, self.denoisers, self.environment)
        except OSError as error:
            return f"The renderer process cannot be started ({error})", False
        with self.changed:
            self.outbox.clear()
        connection = Connection(self, child)
        try:
            with self.changed:
                reason = self._watch(connection)
                if reason is None:
                    self.outbox.append(("leave", {}))
                    self.changed.notify_all()
            if reason is None:
                child.wait(self._timeouts.leave)
            elif not reason:
                child.wait(1.0)
                reason = f"The renderer process {child.ending}"
            return reason or "", connection.usable
        finally:
            child.kill()
            connection.finish()

    def _watch(self, connection: Connection) -> str | None:
        """Wait until a process must be ended or has ended.

        Returns what it is to be blamed for, "" if it just ended, and None if it is to leave.
        """
        timeouts, started = self._timeouts, time.monotonic()
        while not self._leaving and not self._restarting:
            now = time.monotonic()
            if connection.ended:
                return connection.reason
            if not connection.ready:
                wait = started + timeouts.start - now
                if wait <= 0.0:
                    return f"The renderer process did not start within {timeouts.start:g} s"
            elif connection.pinged_at is not None:
                wait = connection.pinged_at + timeouts.answer - now
                if wait <= 0.0:
                    return f"The renderer process did not answer for {timeouts.answer:g} s"
            elif not self.sessions:
                wait = None
            else:
                wait = connection.answered_at + timeouts.ping - now
                if wait <= 0.0:
                    self._limit_log()
                    connection.pinged_at = now
                    self.post("ping")
                    continue
            self.changed.wait(wait)
        return None
