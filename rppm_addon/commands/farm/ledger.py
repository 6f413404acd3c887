# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder beside the pictures in which a farm keeps what it must know to go on where it was."""

import json
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

from ...pictures import PictureError
from .errors import FarmError
from .tasks import PART, Task

ATTEMPT = "attempt_"
"""Begins the names of the folders in which renders are at work. A picture leaves its folder when it is whole."""

_CHANGES = {
    "scene": "another file, or before it was saved again",
    "options": "other options",
    "split": "other parts",
    "RPPM": "another RPPM",
}
"""How to say that an entry of the job is not what it was."""


class Ledger:
    """Knows what the pictures that lie there were made with, and says which are still wanted.

    For ``out/####.exr`` the folder is ``out/####.farm``: ``job.json``, parts of a still and their checkpoints,
    unfinished work.
    """

    def __init__(self, output: Path) -> None:
        self.folder = output.with_suffix(".farm")
        self._file = self.folder / "job.json"

    def open(self, job: Mapping[str, object], tasks: Sequence[Task], overwrite: bool) -> list[Task]:
        """Begin a job or go on with it, and return the tasks whose pictures are not there or not whole.

        Args:
            job: plain values, all that the pictures depend on: scene, options, split, RPPM.
            tasks: all that belong to it.
            overwrite: make pictures anew that are there.

        Raises:
            FarmError: pictures lie there that were made with something else.
            PictureError: the folder cannot be written to.
        """
        there = any(path.is_file() for task in tasks for path in task.files)
        before = self._read()
        try:
            if there and before != job and not overwrite:
                raise FarmError(f"{self._strangers(before, job)}; add --overwrite to make them anew, or change -o")
            if before != job or overwrite:
                self.remove_parts()
            if overwrite:
                for path in (path for task in tasks for path in task.files):
                    path.unlink(missing_ok=True)
            self.folder.mkdir(parents=True, exist_ok=True)
            self.remove_attempts()
            temporary = self._file.with_suffix(".new")
            temporary.write_text(json.dumps(job, indent=2) + "\n", encoding="utf-8")
            temporary.replace(self._file)
        except OSError as error:
            raise PictureError(f"{self.folder} cannot be written to ({error}); choose another place with -o") from error
        return [task for task in tasks if not task.done]

    def remove_attempts(self) -> None:
        """Throw away what renders left whose worker was lost. None may be at work."""
        for path in self.folder.glob(f"{ATTEMPT}*"):
            shutil.rmtree(path, ignore_errors=True)

    def remove_parts(self) -> None:
        """Delete the parts of a still and their checkpoints."""
        for path in self.folder.glob(f"{PART}*"):
            path.unlink(missing_ok=True)

    def _read(self) -> dict[str, object] | None:
        try:
            return json.loads(self._file.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None

    def _strangers(self, before: Mapping[str, object] | None, job: Mapping[str, object]) -> str:
        """Say what is wrong with the pictures that are there."""
        if before is None:
            return f"pictures of these names are there, and {self._file} does not record what they were made with"
        changed = [words for name, words in _CHANGES.items() if before.get(name) != job[name]]
        return f"pictures of these names are there, made with {' and '.join(changed)}"
