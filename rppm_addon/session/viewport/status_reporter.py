# SPDX-License-Identifier: GPL-3.0-or-later
"""The status that a viewport's session sends to Blender."""

import dataclasses
import logging
import time

from ...gl.programs.programs import ProgramLibrary
from ...scene.errors import RppmError, unforeseen
from ..transport.messages import Send
from ..transport.sessions import CompilationProgress, SessionStatus

log = logging.getLogger(__name__)

COMPILATION_SECONDS = 0.1
"""Least time between two reports of the compilation."""


class StatusReporter:
    """Sends the status of a viewport."""

    def __init__(self, send: Send, library: ProgramLibrary) -> None:
        self._send = send
        self._library = library
        self._status = SessionStatus()
        """The last status."""
        self._compilation_reported_at = 0.0
        self._work_before = library.compilation_work().compiled
        """Work that others have done."""
        self._compiled_fraction = 0.0

    def report(self, status: SessionStatus) -> None:
        """Send a status."""
        self._status = status
        self._send("status", status=dataclasses.asdict(status))

    def report_compilation(self) -> None:
        """Send how much is compiled, unless that was sent a moment ago. The fraction never falls."""
        now = time.perf_counter()
        if now - self._compilation_reported_at >= COMPILATION_SECONDS:
            self._compilation_reported_at = now
            work = self._library.compilation_work()
            done, all_of_it = work.compiled - self._work_before, work.known - self._work_before
            self._compiled_fraction = max(self._compiled_fraction, done / max(all_of_it, 1))
            self.report(SessionStatus(compilation=CompilationProgress(self._compiled_fraction)))

    def report_error(self, error: Exception) -> None:
        """Send what is wrong with the scene; the session waits for another one."""
        text = str(error)
        if not isinstance(error, RppmError):
            log.exception("a viewport failed")
            text = unforeseen(error, "please report what its log says")
        self.report(dataclasses.replace(self._status, error=text, settled=True))
