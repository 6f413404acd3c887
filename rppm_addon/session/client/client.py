# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer's process as Blender uses it. No call waits for the process but close()."""

import collections
import enum
import logging
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
from ..transport.sessions import SessionKind
from .client_session import PreparationSession, RenderSession, Session, ViewportSession
from .connection import Connection
from .launcher import ProcessLauncher

logger = logging.getLogger(__name__)

_UNASKED = {SessionKind.PREVIEW, SessionKind.PREPARATION}
"""Kinds of sessions that are opened without a request of the user."""
_AnySession = TypeVar("_AnySession", bound=Session)
MOST_RESTARTS = 2
"""Times that a process which died is started anew without being asked to."""


class ProcessState(enum.Enum):
    """Whether there is a renderer process."""

    STOPPED = "STOPPED"
    """A process is started when a session is opened."""
    STARTING = "STARTING"
    RUNNING = "RUNNING"
    FAILED = "FAILED"
    """The process ended too often or cannot run here; ``error`` says why. restart() and most new sessions try again."""


@dataclass(frozen=True)
class Timeouts:
    """Seconds to wait for the process."""

    start: float = 60.0
    """Until the process has opened the device. The first start after an installation reads much from the disk."""
    answer: float = 300.0
    """Until the process answers a ping, which it does between two slices; a large material may compile for long."""
    leave: float = 1.5
    """Until the process has ended after the message to leave."""
    ping: float = 2.0
    """Time between two pings."""


class RendererProcess:
    """Starts the process when it is first needed, restarts it when it dies, and ends it.

    One thread, the keeper, starts and ends processes; each process has a thread that writes and one that reads. The
    condition ``changed`` guards their common state, and is never held while anything waits.
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
        """Whether the process still opens the other devices."""
        self.launcher = ProcessLauncher(python, folders, log_path, denoisers)
        self.restarts = 0
        self.changed = threading.Condition()
        self._timeouts = timeouts or Timeouts()
        self.sessions: dict[int, Session] = {}
        self._numbers = 0
        self.outbox: collections.deque[tuple[str, dict]] = collections.deque()
        self._keeper: threading.Thread | None = None
        self._leaving = False
        self._restarting = False

    @property
    def log_path(self) -> Path:
        """The file that has what the process logs."""
        return self.launcher.log_path

    def open(self, kind: SessionKind) -> ViewportSession | RenderSession:
        """Open a session for pictures; start the process if there is none.

        After a failure, viewports and final renders try again, since users request them; previews do not.
        """
        if kind is SessionKind.VIEWPORT:
            return self._open(ViewportSession, kind)
        return self._open(RenderSession, kind)

    def prepare(self, scene: Scene) -> None:
        """Compile the programs for a scene before it is rendered; start the process if there is none.

        Only the settings and the materials' graphs matter. After a failure nothing is done.
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

        lists_devices: whether the process opens each device for a moment; until it has, ``is_listing`` is set.
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
        """End the process and all sessions. Waits for the process, a few seconds at most."""
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
        """Queue a message to the process, if there is one. A new process is introduced to all sessions instead."""
        if self.state is ProcessState.RUNNING:
            self.outbox.append((kind, content))
            self.changed.notify_all()

    def greeted(self, device: DeviceInformation) -> None:
        """Announce the sessions to a process that has opened the device."""
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
        """Take the list of devices, each of which the process has opened."""
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
        self.launcher.begin_log()
        while True:
            reason, again = self._run_process()
            if reason:
                logger.warning("%s", reason)  # not where Blender could wait for it
            with self.changed:
                self.device = None
                self.is_listing &= self._restarting  # listing is not tried again after a driver's crash
                if self._leaving:
                    self._end_sessions()
                    self.state, self._keeper = ProcessState.STOPPED, None
                    return
                self.state = ProcessState.STARTING
                if self._restarting:
                    self._restarting = False
                    continue
                self.error = f"{reason}; its log is {self.launcher.log_path}"
                if not again or self.restarts >= MOST_RESTARTS:
                    self.state, self._keeper = ProcessState.FAILED, None
                    for session in self.sessions.values():
                        session.fail(self.error)
                    return
                self.restarts += 1

    def _run_process(self) -> tuple[str, bool]:
        """Run a process to its end. Returns why it ended and whether another one may succeed."""
        try:
            child = self.launcher.start()
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

        Returns why it must be ended, "" if it has ended by itself, and None if it is to leave.
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
                    self.launcher.limit_log()
                    connection.pinged_at = now
                    self.post("ping")
                    continue
            self.changed.wait(wait)
        return None
