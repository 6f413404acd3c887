# SPDX-License-Identifier: GPL-3.0-or-later
"""A session as whoever shows it sees it."""

import dataclasses
from typing import TYPE_CHECKING

from ..scene.scene import Scene
from .frames import FrameReader, SharedFrame
from .protocol import ProtocolError
from .sessions import SessionKind, SessionStatus

if TYPE_CHECKING:
    from .client import RendererProcess


class Session:
    """Something rendered in the renderer's process, a viewport say. All methods return at once."""

    def __init__(self, process: "RendererProcess", number: int, kind: SessionKind) -> None:
        self.kind = kind
        self.number = number
        self.status = SessionStatus()
        """The newest that the process has told."""
        self._process = process
        self._newest: SharedFrame | None = None
        self._snapshot: tuple[Scene, int, bool] | None = None
        self._due = False
        """Whether the snapshot is still to be sent."""
        self._on_its_way = 0
        """The number of the snapshot that was sent and is not yet taken; 0 when there is none."""
        self._sent = 0
        self._paused = False
        self._reader: FrameReader | None = None

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Render ``scene`` from now on, which nobody may change any more.

        Of scenes that come faster than they can be sent, the newest is rendered. Members that earlier scenes had
        are not sent again. ``generation`` grows with each scene; ``navigating`` prefers speed to sharpness.
        """
        with self._process.changed:
            self._snapshot = scene, generation, navigating
            self._due = True
            self._process.changed.notify_all()

    def pause(self, paused: bool) -> None:
        """Stop improving the picture, or go on."""
        with self._process.changed:
            if paused != self._paused:
                self._paused = paused
                self._process.post("pause", session=self.number, paused=paused)

    def newest(self) -> SharedFrame | None:
        """The newest complete frame, never of an older generation than one given before; None before the first."""
        return self._newest

    def close(self) -> None:
        """Render this no more."""
        self._process.close_session(self)

    # For the process's threads; with its ``changed`` held, but for receive_frame.

    def introduce(self) -> None:
        """Tell a new process of this session; its newest scene is to be sent again."""
        self._process.post("open", session=self.number, session_kind=self.kind.name)
        if self._paused:
            self._process.post("pause", session=self.number, paused=True)
        self._due = self._snapshot is not None
        self._on_its_way = 0
        self._reader = None

    def take_snapshot(self) -> tuple[int, Scene, int, bool] | None:
        """What is to be sent now: number, scene, generation, navigating. One is on its way at a time."""
        if not self._due or self._on_its_way:
            return None
        self._due = False
        self._sent += 1
        self._on_its_way = self._sent
        return self._sent, *self._snapshot

    def snapshot_taken(self, number: int) -> None:
        if number == self._on_its_way:
            self._on_its_way = 0

    def fail(self, text: str) -> None:
        """Nothing more will come until another scene is shown."""
        self.status = dataclasses.replace(self.status, error=text, settled=True)

    def use_slots(self, reader: FrameReader) -> None:
        self._reader = reader

    def receive_frame(
        self, slot: int, generation: int, sequence: int, width: int, height: int, progress: float
    ) -> None:
        """Take an announced frame, unless it is none of a scene to be seen. Raises ProtocolError."""
        reader, shown, newest = self._reader, self._snapshot, self._newest
        if reader is None or shown is None:
            raise ProtocolError("a frame came before its slots or its scene")
        combined = reader.read(slot, generation, sequence, width, height)
        if combined is None or generation > shown[1] or (newest is not None and generation < newest.generation):
            return
        # A process that was started anew counts from the beginning.
        own = 1 if newest is None else newest.sequence + 1
        self._newest = SharedFrame(generation, own, width, height, combined, progress)
