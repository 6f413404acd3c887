# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface between a render and its caller, in whichever process the renderer is."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from ..checkpoints.continuation import Continuation
    from .results import Frame, Progress

POLL_SECONDS = 0.05
"""Seconds between two calls of should_stop by a caller that waits."""


class RenderJob:
    """One render, as its caller sees it; all methods run in the caller's thread.

    A render with nothing to show overrides none of them.
    """

    snapshots: tuple[float, ...] = ()

    continuation: "Continuation | None" = None
    """Where the render begins and who receives its state, read after on_start. The renderer's process uses
    ``checkpoint`` instead."""

    checkpoint: "Path | None" = None
    """The file from which a render in the renderer's process continues and in which it is kept; None is none."""

    def should_stop(self) -> bool:
        """Whether the render is to end with what it has."""
        return False

    def on_start(self) -> None:
        """The renderer exists and is about to be given the scene."""

    def on_progress(self, progress: "Progress") -> bool:
        """After each iteration. Returns whether on_frame is to be given the picture."""
        return False

    def on_frame(self, progress: "Progress", frame: "Frame") -> None:
        """The picture so far, as on_progress asked for."""

    def on_snapshot(self, seconds: float, frame: "Frame") -> None:
        """The picture at a mark of ``snapshots``."""
