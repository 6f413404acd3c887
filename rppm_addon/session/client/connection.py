# SPDX-License-Identifier: GPL-3.0-or-later
"""The connection to one renderer process: a thread that writes and a thread that reads."""

import collections
import functools
import logging
import threading
import time
from collections.abc import Callable
from typing import Any, Protocol

from ...gl.context.context import DeviceInformation
from ...gl.context.devices import Device
from ..transport.protocol import FROM_CHILD, VERSION, ProtocolError, check_message
from ..transport.received import received
from .child_process import ChildProcess, ProcessEnded
from .client_session import Session, SessionOwner

logger = logging.getLogger(__name__)

_MOST_MESSAGES = 100
_MESSAGES_SECONDS = 0.05
"""Most messages that are read in this time, so that Blender's own threads run."""


class ConnectionOwner(SessionOwner, Protocol):
    """Owner of the process that is connected."""

    outbox: collections.deque[tuple[str, dict]]
    """Messages to be sent, the oldest first."""

    def greeted(self, device: DeviceInformation) -> None:
        """Announce the sessions to the process, which has opened the device; ``changed`` is held."""

    def devices_listed(self, devices: list[Device]) -> None:
        """Take the list of devices, each of which the process has opened; ``changed`` is held."""


class Connection:
    """Connection to a process while it runs, and its state; guarded by the owner's ``changed``."""

    def __init__(self, owner: ConnectionOwner, child: ChildProcess) -> None:
        """Connect to a process that has just been started."""
        self.ready = False
        """Whether the process has opened the device."""
        self.ended = False
        """Whether nothing more comes from the process."""
        self.reason = ""
        """Reason why the process must be ended; empty if it need not."""
        self.usable = True
        """Whether another process may succeed."""
        self.pinged_at: float | None = None
        """Time of the last ping, until it is answered."""
        self.answered_at = time.monotonic()
        self._owner = owner
        self._child = child
        self._threads = [
            threading.Thread(target=target, name=f"RPPM process, {name}", daemon=True)
            for target, name in ((self._write, "writing"), (self._read, "reading"))
        ]
        for thread in self._threads:
            thread.start()

    def finish(self) -> None:
        """Wait for the threads, after the process has ended."""
        with self._owner.changed:
            self.ended = True
            self._owner.changed.notify_all()
        for thread in self._threads:
            thread.join(1.0)
        if not any(thread.is_alive() for thread in self._threads):
            self._child.close_pipes()

    # In the writing thread.

    def _write(self) -> None:
        try:
            self._child.greet()
            while (task := self._next_task()) is not None:
                task()
        except ProcessEnded:
            pass

    def _next_task(self) -> Callable[[], None] | None:
        owner = self._owner
        with owner.changed:
            while not self.ended:
                if owner.outbox:
                    kind, content = owner.outbox.popleft()
                    if kind == "close":
                        return lambda: self._child.close_session(**content)
                    return lambda: self._child.send(kind, **content)
                if self.ready:
                    for session in owner.sessions.values():
                        if (snapshot := session.take_snapshot()) is not None:
                            return functools.partial(self._send_scene, session, *snapshot)
                owner.changed.wait()
        return None

    def _send_scene(self, session: Session, *snapshot: Any) -> None:
        try:
            self._child.send_scene(session.number, *snapshot)
        except ProcessEnded:
            raise
        except Exception as error:
            logger.exception("a scene could not be sent to the renderer process")
            with self._owner.changed:
                session.snapshot_taken(snapshot[0])
                session.fail(f"The scene could not be sent to the renderer process: {error}")

    # In the reading thread.

    def _read(self) -> None:
        reason = ""
        count, since = 0, time.monotonic()
        try:
            while (message := self._child.read()) is not None:
                self._handle(message)
                count += 1
                if count >= _MOST_MESSAGES:
                    time.sleep(max(0.0, since + _MESSAGES_SECONDS - time.monotonic()))
                    count, since = 0, time.monotonic()
        except (ProtocolError, LookupError, TypeError, ValueError, AttributeError) as error:
            logger.debug("malformed data", exc_info=True)
            reason = f"The renderer process sent what cannot be understood ({type(error).__name__}: {error})"
        except Exception as error:
            logger.exception("the renderer process is read no more")
            reason = f"The renderer process cannot be read ({type(error).__name__}: {error})"
        finally:
            with self._owner.changed:
                self.reason = self.reason or reason
                self.ended = True
                self._owner.changed.notify_all()

    def _handle(self, message: dict) -> None:
        check_message(message, FROM_CHILD)
        kind = message.pop("kind")
        if not self.ready:
            self._handle_greeting(kind, message)
            return
        owner = self._owner
        if kind == "pong":
            with owner.changed:
                self.pinged_at, self.answered_at = None, time.monotonic()
                owner.changed.notify_all()
            return
        if kind == "devices":
            devices = [received(Device, device) for device in message["devices"]]
            with owner.changed:
                owner.devices_listed(devices)
            return
        if kind == "lost":
            with owner.changed:
                self.reason, self.ended = str(message["text"]), True
                owner.changed.notify_all()
            return
        if "session" not in message:
            raise ProtocolError(f"{kind!r} came after the greeting")
        number = message.pop("session")
        if kind == "taken":
            self._child.taken(number, message["number"])
        with owner.changed:
            session = owner.sessions.get(number)
            if kind == "taken" and session is not None:
                session.snapshot_taken(message["number"])
                owner.changed.notify_all()
        if kind != "taken" and session is not None:  # None: it was closed meanwhile
            session.receive(kind, message)

    def _handle_greeting(self, kind: str, message: dict) -> None:
        with self._owner.changed:
            if kind == "unusable":
                self.usable = False
                self.reason = str(message["text"])
                self.ended = True
                self._owner.changed.notify_all()
            elif kind != "ready":
                raise ProtocolError(f"{kind!r} came before the greeting")
            elif message["version"] != VERSION:
                self.usable = False
                raise ProtocolError("RPPM was updated: restart Blender")
            else:
                device = received(DeviceInformation, message["device"] or {})
                self.ready = True
                self.answered_at = time.monotonic()
                self._owner.greeted(device)
