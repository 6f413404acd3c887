# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C, and a machine that is shut down, end a render early instead of throwing its picture away."""

import os
import signal
import socket
import sys
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any

INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it, where nothing else is known."""
_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGBREAK") if hasattr(signal, name))
"""SIGBREAK is Windows' only one that a program can be sent by others, as render managers do."""
GRACE_SECONDS = 1.0
"""Seconds that a program has to end by itself, when it has nothing to keep or was interrupted twice."""


class Interruption:
    """While entered, the first SIGINT (Ctrl-C) or SIGTERM sets ``asked``; a second one raises KeyboardInterrupt.

    Python hears them only between two calls of the driver, of which one that compiles may take a minute. So a thread
    hears them as well, and ends the process where nothing would be lost.
    """

    def __init__(self) -> None:
        self.asked = False
        self.status = 0
        """Exit status of a program that a signal ended, as shells have it."""
        self.has_work: Callable[[], bool] = lambda: True
        """Whether anything was done that is worth waiting for."""
        self._previous: dict[int, Any] = {}
        self._left = threading.Event()

    def __enter__(self) -> "Interruption":
        self._heard, self._signaling = socket.socketpair()
        self._signaling.setblocking(False)
        self._previous_file = signal.set_wakeup_fd(self._signaling.fileno(), warn_on_full_buffer=False)
        threading.Thread(target=self._listen, name="RPPM signals", daemon=True).start()
        for number in _SIGNALS:
            self._previous[number] = signal.signal(number, self._handle)
        return self

    def __exit__(self, *_: object) -> None:
        self._left.set()
        for number, handler in self._previous.items():
            signal.signal(number, handler)
        signal.set_wakeup_fd(self._previous_file)
        self._signaling.close()

    def _handle(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked, self.status = True, 128 + number

    def _listen(self) -> None:
        count = 0
        with self._heard:
            while number := self._heard.recv(1):
                if number[0] not in self._previous:
                    continue
                count += 1
                if count > 1 or not self.has_work():
                    self._end_soon(number[0], count > 1)

    def _end_soon(self, number: int, insisted: bool) -> None:
        """End the process unless it has ended by itself, or come to something that is worth keeping."""
        if self._left.wait(GRACE_SECONDS) or (self.has_work() and not insisted):
            return
        sys.stderr.write("\nrppm: interrupted" + ("\n" if self.has_work() else "; nothing was done yet\n"))
        sys.stderr.flush()
        os._exit(128 + number)
