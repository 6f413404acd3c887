# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames that a viewport's session sends to Blender."""

import numpy as np

from ..transport.frames import FrameWriter
from ..transport.messages import Send

BRIGHTEST = 65000.0
"""Largest value of a frame. Windows draw half floats, which end there; infinity would be drawn black."""


class FrameSender:
    """Writes frames to shared memory and announces them to Blender."""

    def __init__(self, send: Send) -> None:
        self._send = send
        self._writer = FrameWriter()
        self.newest_generation = 0
        """Generation of the last frame; 0 before the first."""

    def send(self, combined: np.ndarray, generation: int, progress: float) -> None:
        """Send a picture, (height, width, 4) float32, which is clamped in place: no window waits here.

        Args:
            combined: scene-linear Rec.709 with premultiplied alpha, row 0 at the bottom.
            generation: generation of the scene that the picture shows.
            progress: fraction of the iterations done, 0 to 1; 0 for a picture that was not rendered.
        """
        np.nan_to_num(combined, copy=False, nan=0.0, posinf=BRIGHTEST, neginf=0.0)
        np.minimum(combined, BRIGHTEST, out=combined)
        height, width = combined.shape[:2]
        slots = self._writer.reserve(width * height)
        if slots is not None:
            self._send("slots", **slots)
        self.newest_generation = generation
        self._send("frame", **self._writer.write(generation, combined), progress=progress)

    def release(self) -> None:
        """Give the shared memory back."""
        self._writer.release()
