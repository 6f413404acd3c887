# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C, and a machine that is shut down, end a render early instead of throwing its picture away."""

import signal
from types import FrameType
from typing import Any

INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it, where nothing else is known."""


class Interruption:
    """While entered, the first SIGINT (Ctrl-C) or SIGTERM sets ``asked``; a second one raises KeyboardInterrupt."""

    def __init__(self) -> None:
        self.asked = False
        self.status = 0
        """Exit status of a program that a signal ended, as shells have it."""
        self._previous: dict[int, Any] = {}

    def __enter__(self) -> "Interruption":
        for number in (signal.SIGINT, signal.SIGTERM):
            self._previous[number] = signal.signal(number, self._handle)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)

    def _handle(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked, self.status = True, 128 + number
