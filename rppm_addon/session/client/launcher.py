# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts renderer processes and keeps their log short."""

import contextlib
import logging
import os
from collections.abc import Sequence
from pathlib import Path

from ...denoising.places import LibraryPlace
from .child_process import ChildProcess

logger = logging.getLogger(__name__)

LARGEST_LOG = 1 << 24
"""Bytes after which the log begins anew."""


class ProcessLauncher:
    """Starts renderer processes, one after another, with the same program and log."""

    def __init__(
        self, python: Sequence[str], folders: Sequence[str], log_path: Path, denoisers: Sequence[LibraryPlace]
    ) -> None:
        """Take the arguments of RendererProcess. Nothing is started yet."""
        self.python = list(python)
        self._folders = list(folders)
        self.log_path = log_path
        self.denoisers = list(denoisers)
        """Denoiser libraries of the next process, in the order in which they are tried."""
        self.environment: dict[str, str] = {}
        """Environment variables of the next process, over Blender's own."""

    def start(self) -> ChildProcess:
        """Start a process, which appends to the log. Raises OSError when it cannot be started."""
        return ChildProcess(self.python, self._folders, self.log_path, self.denoisers, self.environment)

    def begin_log(self) -> None:
        """Empty the log. A log that cannot be written is no reason not to render."""
        try:
            self.log_path.parent.mkdir(parents=True, exist_ok=True)
            self.log_path.write_bytes(b"")
        except OSError as error:
            logger.warning("the log cannot be written: %s", error)

    def limit_log(self) -> None:
        """Empty a log that has grown large, so that a driver that logs all the time does not fill the disk."""
        with contextlib.suppress(OSError):
            if self.log_path.stat().st_size > LARGEST_LOG:
                os.truncate(self.log_path, 0)  # the process appends, so it can continue
