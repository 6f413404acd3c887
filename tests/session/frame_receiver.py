# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's end of a viewport's session, for sessions that run in the test's own process."""

from typing import NamedTuple

import numpy as np

from rppm_addon.session.transport.frames import FrameReader


class ReceivedFrame(NamedTuple):
    """A frame as Blender copies it from shared memory."""

    generation: int
    progress: float
    combined: np.ndarray


class FrameReceiver:
    """Takes what a session sends: frames and statuses, the oldest first."""

    def __init__(self):
        self.frames: list[ReceivedFrame] = []
        self.statuses: list[dict] = []
        self._reader = None

    def __call__(self, kind, **content):
        if kind == "slots":
            self._reader = FrameReader(**content)
        elif kind == "status":
            self.statuses.append(content["status"])
        elif kind == "frame":
            progress = content.pop("progress")
            self.frames.append(ReceivedFrame(content["generation"], progress, self._reader.read(**content)))

    @property
    def shown(self):
        """Generation and progress of each frame."""
        return [(frame.generation, frame.progress) for frame in self.frames]

    @property
    def picture(self):
        """The last frame's picture."""
        return self.frames[-1].combined
