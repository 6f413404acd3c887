# SPDX-License-Identifier: GPL-3.0-or-later
"""A progress bar on a terminal, a line now and then elsewhere."""

import logging
import shutil
import time
from typing import TextIO

_REDRAW_SECONDS = 0.1
LINE_SECONDS = 10.0


class ProgressBar:
    """Shows a fraction and a few words on a stream."""

    def __init__(self, stream: TextIO, line_seconds: float) -> None:
        self._stream = stream
        self._line_seconds = line_seconds
        self._terminal = stream.isatty()
        self._due = 0.0
        self._drawn = False

    def show(self, fraction: float, words: str) -> None:
        """Show a fraction of 0 to 1; calls that come too soon after another are left out."""
        now = time.monotonic()
        fraction = min(max(fraction, 0.0), 1.0)
        if now < self._due and fraction < 1.0:
            return
        self._due = now + (_REDRAW_SECONDS if self._terminal else self._line_seconds)
        if not self._terminal:
            self._stream.write(f"{fraction:4.0%} {words}\n")
            self._stream.flush()
            return
        columns = shutil.get_terminal_size().columns
        room = min(30, columns - len(words) - 9)
        bar = ""
        if room >= 5:
            filled = round(fraction * room)
            bar = f"[{'#' * filled}{'.' * (room - filled)}] "
        self._stream.write(f"\r{fraction:4.0%} {bar}{words}"[: columns - 1] + "\x1b[K")
        self._stream.flush()
        self._drawn = True

    def clear(self) -> None:
        """Take the bar away so that other text can be written."""
        if self._drawn:
            self._stream.write("\r\x1b[K")
            self._stream.flush()
            self._drawn = False


class PartBar:
    """Shows the progress of one of several renders as a part of all."""

    def __init__(self, bar: "ProgressBar | PartBar", place: int, count: int, words: str) -> None:
        """words: what it is of."""
        self._bar, self._place, self._count, self._words = bar, place, count, words

    def show(self, fraction: float, words: str) -> None:
        """As ProgressBar has it."""
        part = min(max(fraction, 0.0), 0.999)  # whole only with the last
        self._bar.show((self._place + part) / self._count, f"{self._words}, {words}")


class BarLogHandler(logging.StreamHandler):
    """Writes log records to the bar's stream without mixing them with the bar."""

    def __init__(self, bar: ProgressBar, stream: TextIO) -> None:
        super().__init__(stream)
        self._bar = bar

    def emit(self, record: logging.LogRecord) -> None:
        """Write a line, from which the bar makes way."""
        self._bar.clear()
        super().emit(record)
