# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's side of the sessions in the renderer's process."""

import dataclasses
import queue
import threading
from pathlib import Path
from typing import Protocol

from ...scene.scene import Scene
from ..render.results import Progress, RenderStatistics
from ..transport.arrays import unpack
from ..transport.frames import FrameReader, SharedFrame
from ..transport.kept_renders import KeptRender
from ..transport.protocol import ProtocolError
from ..transport.received import received
from ..transport.sessions import SessionKind, SessionStatus
from ..transport.shared_memory import SharedBlock


class SessionOwner(Protocol):
    """The process that renders sessions."""

    changed: threading.Condition
    """Guards the state that sessions and the process have in common."""
    sessions: dict[int, "Session"]
    """Open sessions by number."""
    error: str
    """Reason why the previous process has ended; empty if there was none."""

    def post(self, kind: str, **content: object) -> None:
        """Queue a message to the process, if there is one."""

    def close_session(self, session: "Session") -> None:
        """Forget a session."""


class Session:
    """A session in the renderer's process. No method waits for the process."""

    def __init__(self, process: SessionOwner, number: int, kind: SessionKind) -> None:
        self.kind = kind
        self.number = number
        self.process = process
        self._snapshot: tuple[Scene, int, bool] | None = None
        self._due = False
        """Whether the snapshot is still to be sent."""
        self._on_its_way = 0
        """Number of the snapshot that was sent and is not yet received; 0 when there is none."""
        self._sent = 0

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Render ``scene`` from now on. It must not be changed any more.

        If scenes come faster than they can be sent, only the newest is sent. Members that earlier scenes had are not
        sent again. ``generation`` grows with each scene; ``navigating`` prefers speed to resolution.
        """
        with self.process.changed:
            self._snapshot = scene, generation, navigating
            self._due = True
            self.process.changed.notify_all()

    def close(self) -> None:
        """End the session."""
        self.process.close_session(self)

    @property
    def is_open(self) -> bool:
        """Whether neither the session nor the process was closed."""
        with self.process.changed:
            return self.process.sessions.get(self.number) is self

    # For the process's threads, with its ``changed`` held.

    def introduce(self) -> None:
        """Open the session in a new process, and send its newest scene again."""
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
        """Record that the process has the scene of this number: the next one may be sent."""
        if number == self._on_its_way:
            self._on_its_way = 0

    def release(self) -> None:
        """Free all that is large; the session is closed."""
        self._snapshot = None
        self._due = False

    def fail(self, text: str) -> None:
        """Report an error. Nothing more comes until another scene is shown, or another process is started."""
        raise NotImplementedError

    # In the reading thread.

    def receive(self, kind: str, content: dict) -> None:
        """Handle a message of the process. Raises ProtocolError, or an error of unpacking, for malformed data."""
        raise NotImplementedError


class ViewportSession(Session):
    """A viewport: pictures that improve, of a scene that changes."""

    def __init__(self, process: SessionOwner, number: int, kind: SessionKind) -> None:
        super().__init__(process, number, kind)
        self.status = SessionStatus()
        """The newest status that the process has reported."""
        self._newest: SharedFrame | None = None
        self._paused = False
        self._reader: FrameReader | None = None

    def pause(self, paused: bool) -> None:
        """Stop improving the picture, or continue."""
        with self.process.changed:
            if paused != self._paused:
                self._paused = paused
                self.process.post("pause", session=self.number, paused=paused)

    def newest(self) -> SharedFrame | None:
        """Return the newest complete frame, never of an older generation than a previous one; None before the first."""
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
        """Copy an announced frame, unless it is older than the last one or of an unknown scene."""
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
    """Final renders: scenes that are rendered to their end, one after the other."""

    def __init__(self, process: SessionOwner, number: int, kind: SessionKind) -> None:
        super().__init__(process, number, kind)
        self.events: queue.SimpleQueue[tuple[str, dict]] = queue.SimpleQueue()
        """Messages of the process by kind; "started" when there is a process."""
        self.introduced = False
        """Whether a process has opened the session. From then on scenes reach each new process."""
        self._snapshots: tuple[float, ...] = ()
        self._checkpoint = ""
        self._stopping = False
        self._generation = 0
        self._kept: KeptRender | None = None
        """State with which another process continues the render."""
        self._state_block: SharedBlock | None = None
        """Shared memory from which the other process reads that state."""

    def begin(self, scene: Scene) -> None:
        """Render a scene to its end; no other one may be under way. Members of the scene before stay on the device."""
        with self.process.changed:
            self._stopping = False
            self._kept = None
            self._generation += 1
            self.show(scene, self._generation, False)

    def rest(self) -> None:
        """Forget the scene, which is rendered: a new process does not render it again."""
        with self.process.changed:
            self._snapshot = self._kept = None
            self._due = False

    def expect_snapshots(self, seconds: tuple[float, ...]) -> None:
        """Request the picture of the next scene at ascending times."""
        with self.process.changed:
            self._snapshots = seconds
            self.process.post("expect_snapshots", session=self.number, seconds=seconds)

    def set_checkpoint(self, checkpoint: Path | None) -> None:
        """Continue the next scene from a checkpoint and keep its render there; None is none."""
        with self.process.changed:
            self._checkpoint = str(checkpoint or "")
            self.process.post("set_checkpoint", session=self.number, path=self._checkpoint)

    def request_picture(self) -> None:
        """Request the picture so far."""
        with self.process.changed:
            self.process.post("request_picture", session=self.number)

    def stop(self) -> None:
        """End the render with the picture that it has."""
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
        self._hand_over()
        if self._stopping:
            self.process.post("stop", session=self.number, generation=self._generation)
        self.events.put(("started", {}))

    def _hand_over(self) -> None:
        """Have a new process continue the render."""
        if self._kept is None:
            return
        try:
            content, self._state_block = self._kept.message(self.process.error)
        except OSError:  # there is no memory: it begins again
            return
        self.process.post("resume", session=self.number, **content)

    def snapshot_taken(self, number: int) -> None:
        """As Session has it; the state that was handed over is read as well."""
        super().snapshot_taken(number)
        self._free_state()

    def release(self) -> None:
        """As Session has it."""
        super().release()
        self._kept = None
        self._free_state()

    def _free_state(self) -> None:
        if self._state_block is not None:
            self._state_block.close()
            self._state_block = None

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
    """Compilation of programs before a render needs them. The session closes by itself."""

    def fail(self, text: str) -> None:
        """Ignore the error: the render that follows reports it."""

    def receive(self, kind: str, content: dict) -> None:
        """As Session has it."""
        if kind != "prepared":
            raise ProtocolError(f"a preparation has no message {kind!r}")
        self.close()
