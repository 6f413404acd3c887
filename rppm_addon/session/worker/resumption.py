# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the next render of a session begins: its checkpoint, or the state that an ended process has left."""

from collections.abc import Sequence
from pathlib import Path

from ...scene.scene import Scene
from ..checkpoints.checkpoint_writer import CheckpointWriter, continued_still
from ..checkpoints.continuation import Continuation, Pause, place_of


class Resumption:
    """Chooses the state from which the next render continues."""

    def __init__(self) -> None:
        self.checkpoint = ""
        """Path of the file from which renders continue and in which they are kept; "" is none."""
        self._handed_over: tuple[Pause, float, str] | None = None
        """State of the render, seconds that it has taken, and why the process before has ended."""

    def hand_over(self, pause: Pause | None, seconds: float, reason: str) -> None:
        """Continue the next render where an ended process has left it; None: begin anew."""
        self._handed_over = None if pause is None else (pause, seconds, reason)

    def begin(self, scene: Scene, snapshots: Sequence[float]) -> tuple[CheckpointWriter | None, Continuation]:
        """Return the writer of the scene's checkpoint, if it has one, and where its render begins.

        Args:
            scene: the scene; its warnings report that another process continues its render.
            snapshots: ascending seconds. Those that the ended process has handed out are counted as such.
        """
        writer, continuation = None, Continuation()
        if self.checkpoint:
            writer, continuation = continued_still(Path(self.checkpoint), scene)
        if self._handed_over is not None:
            (pause, seconds, reason), self._handed_over = self._handed_over, None
            kept = continuation.begin
            if kept is None or kept.state.iteration < pause.state.iteration:
                continuation.begin = pause
            continuation.seconds = seconds
            continuation.snapshots_taken = sum(mark <= seconds for mark in snapshots)
            scene.warn(f"{reason}; the render went on {place_of(continuation.begin)} in another process")
        return writer, continuation
