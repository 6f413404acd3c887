# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions as whoever shows them sees them."""

import dataclasses
import queue
import threading
from pathlib import Path
from typing import Protocol

from ...scene.scene import Scene
from ..results import Progress, RenderStatistics
from .arrays import unpack
from .frames import FrameReader, SharedFrame
from .kept_renders import KeptRender
from .protocol import ProtocolError
from .received import received
from .sessions import SessionKind, SessionStatus
from .shared_memory import SharedBlock


class SessionOwner(Protocol):
    """The process that renders sessions, as they see it."""

    changed: threading.Condition
    """Guards all that sessions and the process share."""
    sessions: dict[int, "Session"]
    """The open ones by their numbers."""
    error: str
    """Why the process before has ended, if it did."""

    def post(self, kind: str, **content: object) -> None:
        """Have a message sent to the process, if there is one."""

    def close_session(self, session: "Session") -> None:
        """Forget a session."""


class Session:
    """Something rendered in the renderer's process. All methods return at once."""

    def __init__(self, process: SessionOwner, number: int, kind: SessionKind) -> None:
        self.kind = kind
        self.number = number
        self.process = process
        self._snapshot: tuple[Scene, int, bool] | None = None
        self._due = False
        """Whether the snapshot is still to be sent."""
        self._on_its_way = 0
        """The number of the snapshot that was sent and is not yet taken; 0 when there is none."""
        self._sent = 0

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Render ``scene`` from now on, which nobody may change any more.

        Of scenes that come faster than they can be sent, the newest is rendered. Members that earlier scenes had
        are not sent again. ``generation`` grows with each scene; ``navigating`` prefers speed to sharpness.
        """
        with self.process.changed:
            self._snapshot = scene, generation, navigating
            self._due = True
            self.process.changed.notify_all()

    def close(self) -> None:
        """Render this no more."""
        self.process.close_session(self)

    @property
    def is_open(self) -> bool:
        """Whether neither the session nor the process was closed."""
        with self.process.changed:
            return self.process.sessions.get(self.number) is self

    # For the process's threads, with its ``changed`` held.

    def introduce(self) -> None:
        """Tell a new process of this session; its newest scene is to be sent again."""
        self.process.post("open", session=self.number, session_kind=self.kind.name)
        self._due = self._snapshot is not None
        self._on_its_way = 0

    def take_snapshot(self) -> tuple[int, Scene, int, bool] | None:
        """Return the number, scene, generation and navigating of the snapshot to send now, or None.

        Only one snapshot is on its way at a time.
        """
        if not self._due or self._on_its_way or self._snapshot is None:
            return None
        self._due = False
        self._sent += 1
        self._on_its_way = self._sent
        return self._sent, *self._snapshot

    def snapshot_taken(self, number: int) -> None:
        """The process has the scene of this number: the next one may be sent."""
        if number == self._on_its_way:
            self._on_its_way = 0

    def release(self) -> None:
        """The session is closed: keep nothing that is large."""
        self._snapshot = None
        self._due = False

    def fail(self, text: str) -> None:
        """Nothing more will come until another scene is shown, or another process is started."""
        raise NotImplementedError

    # In the reading thread.

    def receive(self, kind: str, content: dict) -> None:
        """A message of the process. Raises ProtocolError, or what unpacking it raises, for malformed data."""
        raise NotImplementedError


class ViewportSession(Session):
    """A picture that grows, of a scene that changes."""

    def __init__(self, process: SessionOwner, number: int, kind: SessionKind) -> None:
        super().__init__(process, number, kind)
        self.status = SessionStatus()
        """The newest that the process has reported."""
        self._newest: SharedFrame | None = None
        self._paused = False
        self._reader: FrameReader | None = None

    def pause(self, paused: bool) -> None:
        """Stop improving the picture, or go on."""
        with self.process.changed:
            if paused != self._paused:
                self._paused = paused
                self.process.post("pause", session=self.number, paused=paused)

    def newest(self) -> SharedFrame | None:
        """The newest complete frame, never of an older generation than one given before; None before the first."""
        return self._newest

    def introduce(self) -> None:
        """As Session has it."""
        super().introduce()
        self._reader = None
        self.status = dataclasses.replace(self.status, error="", settled=False)
        if self._paused:
            self.process.post("pause", session=self.number, paused=True)

    def release(self) -> None:
        """As Session has it."""
        super().release()
        self._reader = None

    def fail(self, text: str) -> None:
        """As Session has it."""
        self.status = dataclasses.replace(self.status, error=text, settled=True)

    def receive(self, kind: str, content: dict) -> None:
        """As Session has it."""
        if kind == "frame":
            self._receive_frame(**content)
        elif kind == "status":
            self.status = received(SessionStatus, content["status"])
        elif kind == "slots":
            try:
                self._reader = FrameReader(**content)
            except FileNotFoundError:  # others are announced already
                self._reader = None
        else:
            raise ProtocolError(f"a viewport has no message {kind!r}")

    def _receive_frame(
        self, slot: int, generation: int, sequence: int, width: int, height: int, progress: float
    ) -> None:
        """Take an announced frame, unless it is none of a scene to be seen."""
        if not 0.0 <= progress <= 1.0:
            raise ProtocolError(f"a frame cannot show {progress} of a picture")
        reader, shown, newest = self._reader, self._snapshot, self._newest
        if reader is None or shown is None:
            return
        combined = reader.read(slot, generation, sequence, width, height)
        if combined is None or generation > shown[1] or (newest is not None and generation < newest.generation):
            return
        # A process that was started anew counts from the beginning.
        own = 1 if newest is None else newest.sequence + 1
        self._newest = SharedFrame(generation, own, width, height, combined, progress)


class RenderSession(Session):
    """Scenes that are each rendered once, to their end, one after the other."""

    def __init__(self, process: SessionOwner, number: int, kind: SessionKind) -> None:
        super().__init__(process, number, kind)
        self.events: queue.SimpleQueue[tuple[str, dict]] = queue.SimpleQueue()
        """Messages of the process, in the protocol's words; "started" when there is a process."""
        self.introduced = False
        """Whether there has been a process that knows the session; scenes shown to another one will reach it."""
        self._snapshots: tuple[float, ...] = ()
        self._checkpoint = ""
        self._stopping = False
        self._generation = 0
        self._kept: KeptRender | None = None
        """Render that another process is to go on with."""
        self._given: SharedBlock | None = None
        """Shared memory that the other process reads the kept render from."""

    def begin(self, scene: Scene) -> None:
        """Render a scene to its end; no other one may be under way. What it shares with the scene before stays."""
        with self.process.changed:
            self._stopping = False
            self._kept = None
            self._generation += 1
            self.show(scene, self._generation, False)

    def rest(self) -> None:
        """The scene is rendered: a process that is started anew need not begin again with it."""
        with self.process.changed:
            self._snapshot = self._kept = None
            self._due = False

    def expect_snapshots(self, seconds: tuple[float, ...]) -> None:
        """Ask for the picture at ascending times; to be said before a scene begins."""
        with self.process.changed:
            self._snapshots = seconds
            self.process.post("expect_snapshots", session=self.number, seconds=seconds)

    def set_checkpoint(self, checkpoint: Path | None) -> None:
        """Have the scene go on from a checkpoint and be kept in it; to be said before a scene begins."""
        with self.process.changed:
            self._checkpoint = str(checkpoint or "")
            self.process.post("set_checkpoint", session=self.number, path=self._checkpoint)

    def request_picture(self) -> None:
        """Ask for the picture so far."""
        with self.process.changed:
            self.process.post("request_picture", session=self.number)

    def stop(self) -> None:
        """Have the render end with what it has."""
        with self.process.changed:
            if not self._stopping:
                self._stopping = True
                self.process.post("stop", session=self.number, generation=self._generation)

    def introduce(self) -> None:
        """As Session has it."""
        super().introduce()
        self.introduced = True
        self.process.post("expect_snapshots", session=self.number, seconds=self._snapshots)
        self.process.post("set_checkpoint", session=self.number, path=self._checkpoint)
        self._hand_on()
        if self._stopping:
            self.process.post("stop", session=self.number, generation=self._generation)
        self.events.put(("started", {}))

    def _hand_on(self) -> None:
        """Have a new process go on with what the one before has kept."""
        if self._kept is None:
            return
        try:
            content, self._given = self._kept.message(self.process.error)
        except OSError:  # there is no memory: it begins again
            return
        self.process.post("resume", session=self.number, **content)

    def snapshot_taken(self, number: int) -> None:
        """As Session has it; what was handed on before is read as well."""
        super().snapshot_taken(number)
        self._take_back()

    def release(self) -> None:
        """As Session has it."""
        super().release()
        self._kept = None
        self._take_back()

    def _take_back(self) -> None:
        if self._given is not None:
            self._given.close()
            self._given = None

    def fail(self, text: str) -> None:
        """As Session has it."""
        self.events.put(("failed", {"error": "RendererError", "text": text}))

    def receive(self, kind: str, content: dict) -> None:
        """As Session has it."""
        if kind not in ("progress", "picture", "snapshot", "kept", "result", "failed"):
            raise ProtocolError(f"a render has no message {kind!r}")
        if "progress" in content:
            content["progress"] = received(Progress, content["progress"])
        if "statistics" in content:
            content["statistics"] = received(RenderStatistics, content["statistics"])
        if "arrays" in content:
            description = content["arrays"]
            content["arrays"] = unpack(description)
            if "block" in description:
                with self.process.changed:
                    self.process.post("received", session=self.number)
        if kind == "kept":
            self._keep(**content)
        else:
            self.events.put((kind, content))

    def _keep(self, document: dict, arrays: list, generation: int, seconds: float) -> None:
        with self.process.changed:
            if generation == self._generation and self._snapshot is not None:
                self._kept = KeptRender(document, arrays, seconds)


class PreparationSession(Session):
    """Programs that are compiled before anybody waits for them. It closes by itself."""

    def fail(self, text: str) -> None:
        """As Session has it: whoever renders says what is wrong."""

    def receive(self, kind: str, content: dict) -> None:
        """As Session has it."""
        if kind != "prepared":
            raise ProtocolError(f"a preparation has no message {kind!r}")
        self.close()
