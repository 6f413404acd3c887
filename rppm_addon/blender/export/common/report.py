# SPDX-License-Identifier: GPL-3.0-or-later
"""Warnings and progress of an export for the user, and how it is interrupted."""

import contextlib
import logging
from collections.abc import Callable, Hashable, Iterable, Iterator

from ....scene.errors import RppmError
from .slices import Slices

logger = logging.getLogger(__name__)

_NAMES_SHOWN = 3


def listed(names: Iterable[str]) -> str:
    """The first of the names in their order, and how many more there are."""
    ordered = sorted(names)
    shown = ", ".join(f'"{name}"' for name in ordered[:_NAMES_SHOWN])
    more = len(ordered) - _NAMES_SHOWN
    return f"{shown} and {more} more" if more > 0 else shown


class ExportStopped(RppmError):
    """The user stopped the render while the scene was exported."""


class Report:
    """Collects warnings without repeating them and asks whether to go on."""

    def __init__(
        self, should_stop: Callable[[], bool] | None = None, show: Callable[[str], None] | None = None
    ) -> None:
        self._warnings: dict[Hashable, dict[str, None]] = {}
        self._part: Hashable = None
        self._logged: set[str] = set()
        self._should_stop = should_stop
        self._show = show
        self.slices = Slices()
        """Time slices of an export that lets Blender go on between them."""

    @property
    def warnings(self) -> list[str]:
        """One line each, which names the thing and what was done about it."""
        return list({text: None for texts in self._warnings.values() for text in texts})

    @contextlib.contextmanager
    def about(self, part: Hashable, is_continued: bool = False) -> Iterator[None]:
        """Forget the warnings about a part, which the with block exports, unless its export ``is_continued``."""
        outer, self._part = self._part, part
        if not is_continued:
            self._warnings.pop(part, None)
        try:
            yield
        finally:
            self._part = outer

    def warn(self, text: str) -> None:
        """Record one line, and log it the first time."""
        self._warnings.setdefault(self._part, {})[text] = None
        if text not in self._logged:
            self._logged.add(text)
            logger.warning(text)

    def progress(self, text: str) -> None:
        """Show what is being exported; raises ExportStopped when the user wants no more."""
        if self._should_stop is not None and self._should_stop():
            raise ExportStopped("the export was stopped")
        if self._show is not None:
            self._show(text)
