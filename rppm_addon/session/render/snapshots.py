# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a render that is under way, at times that the caller names."""

from collections.abc import Callable, Sequence

from ..checkpoints.continuation import Continuation
from .results import Frame


class SnapshotSchedule:
    """Hands out the picture at ascending times of a render."""

    def __init__(
        self, marks: Sequence[float], on_snapshot: Callable[[float, Frame], None] | None, continuation: Continuation
    ) -> None:
        """Skip the snapshots that the continued render has handed out.

        Args:
            marks: ascending seconds since the render began.
            on_snapshot: receives a mark and its picture.
            continuation: counts the snapshots, so that a render that begins again does not repeat them.
        """
        self._pending = list(marks[continuation.snapshots_taken :])
        self._on_snapshot = on_snapshot
        self._continuation = continuation

    def take(self, seconds: float, read_frame: Callable[[], Frame]) -> None:
        """Hand out the picture for each mark that is not later than ``seconds``."""
        while self._pending and seconds >= self._pending[0]:
            mark = self._pending.pop(0)
            if self._on_snapshot is not None:
                self._on_snapshot(mark, read_frame())
                self._continuation.snapshots_taken += 1
