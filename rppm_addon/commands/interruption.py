# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C ends a render early instead of throwing its picture away."""

import signal
from types import FrameType


class Interruption:
    """While entered, the first Ctrl-C sets ``asked``; a second one raises KeyboardInterrupt."""

    def __init__(self) -> None:
        self.asked = False
        self._previous = None

    def __enter__(self) -> "Interruption":
        self._previous = signal.signal(signal.SIGINT, self._handle)
        return self

    def __exit__(self, *_: object) -> None:
        signal.signal(signal.SIGINT, self._previous)

    def _handle(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True
