# SPDX-License-Identifier: GPL-3.0-or-later
"""What an export has to say to the user, and how it is interrupted."""

import logging
from collections.abc import Callable

from ...scene.errors import RppmError

logger = logging.getLogger(__name__)


class ExportStopped(RppmError):
    """The user stopped the render while the scene was exported."""


class Report:
    """Collects warnings without repeating them and asks whether to go on."""

    def __init__(self, should_stop: Callable[[], bool] | None = None, show: Callable[[str], None] | None = None):
        self.warnings: list[str] = []
        self._known: set[str] = set()
        self._should_stop = should_stop
        self._show = show

    def warn(self, text: str) -> None:
        """Record and log one line that names the thing and what was done about it."""
        if text not in self._known:
            self._known.add(text)
            self.warnings.append(text)
            logger.warning(text)

    def progress(self, text: str) -> None:
        """Show what is being exported; raises ExportStopped when the user wants no more."""
        if self._should_stop is not None and self._should_stop():
            raise ExportStopped("the export was stopped")
        if self._show is not None:
            self._show(text)
