# SPDX-License-Identifier: GPL-3.0-or-later
"""Tasks that a farm hands out: each is one call of the rppm program, with the pictures that it makes."""

import contextlib
import io
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

from ...scene.errors import SceneError, SettingsError
from ...scene.storage.validation import check_record
from ..options.arguments import parser
from ..options.frame_numbers import path_of_frame
from ..picture_files import is_whole

PART = "samples_"
"""Begins the names of the parts of a still and of their checkpoints."""
CHECKPOINT = ".checkpoint.exr"
"""Ends the latter."""


@dataclass(frozen=True)
class Task:
    """One call of the program: frames, one after the other, a part of a still, or the merging of parts."""

    arguments: tuple[str, ...]
    """Arguments of rppm, without those for frames and outputs."""
    outputs: tuple[Path, ...]
    """The pictures; of frames, with #### for the number."""
    frames: tuple[int, ...] = ()
    words: str = ""
    """Name of a task that has no frames."""

    def check(self, folder: Path) -> None:
        """Raise SettingsError unless this is a task as those below make them, of a farm whose ledger is ``folder``: it
        has come over a network, and names files that are to be replaced."""
        try:
            check_record(self, Task)
        except SceneError as error:
            raise SettingsError(f"a task that is none: {error}") from error
        for path in (*self.outputs, folder):
            if not path.is_absolute() or ".." in path.parts:
                raise SettingsError(f"a task's files must have absolute paths without .., unlike {path}")
        names = {path.name for path in self.outputs if path.suffix in (".exr", ".png")}
        if not self.outputs or len(names) != len(self.outputs):
            raise SettingsError("a task needs .exr and .png files of different names")
        written = _written(self.command(self.outputs))
        if any(path.parent != folder for path in written - {*self.outputs}):
            raise SettingsError(f"a task may write its outputs and what lies in {folder} only: {self.command_line}")

    @property
    def name(self) -> str:
        """As users see it: ``frame 7``."""
        if len(self.frames) < 2:
            return f"frame {self.frames[0]}" if self.frames else self.words
        return f"frames {', '.join(map(str, self.frames))}"

    @property
    def files(self) -> tuple[Path, ...]:
        """All pictures. The task is done when they are there and whole."""
        if not self.frames:
            return self.outputs
        return tuple(path_of_frame(path, frame) for frame in self.frames for path in self.outputs)

    @property
    def done(self) -> bool:
        """Whether all pictures can be read to their end."""
        return all(is_whole(path) for path in self.files)

    @property
    def singles(self) -> list["Task"]:
        """A task for each frame."""
        return [replace(self, frames=(frame,)) for frame in self.frames] or [self]

    @property
    def rest(self) -> "Task":
        """The task without the frames that are done."""
        frames = tuple(frame for single in self.singles if not single.done for frame in single.frames)
        return replace(self, frames=frames) if frames else self

    def command(self, outputs: Sequence[Path]) -> list[str]:
        """The arguments of rppm with the pictures under other names."""
        frames = ["--frames", ",".join(map(str, self.frames))] if self.frames else []
        return [*self.arguments, *frames, *(word for path in outputs for word in ("-o", str(path)))]

    @property
    def command_line(self) -> str:
        """Command line that a user would type to do the same."""
        return shlex.join(["rppm", *self.command(self.outputs)])


def _written(command: list[str]) -> set[Path]:
    """All files that a call of rppm names to be written. Raises SettingsError unless it renders or merges."""
    try:
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
            options = parser().parse_args(command)
    except SystemExit as error:
        raise SettingsError(f"a task that rppm does not understand: {shlex.join(command)}") from error
    if options.command not in ("render", "merge"):
        raise SettingsError(f"a task may render or merge, not {options.command}")
    return {*options.output, *(path for path in (options.json, getattr(options, "checkpoint", None)) if path)}


def frame_tasks(file: Path, frames: Sequence[int], outputs: Sequence[Path], options: Sequence[str]) -> list[Task]:
    """A task for each frame; ``options`` are those of rppm render."""
    return Task(("render", str(file), *options), tuple(outputs), tuple(frames)).singles


def chunks(tasks: Sequence[Task], length: int) -> list[Task]:
    """Tasks of one frame each, put together: as many frames at most with one start of Blender."""
    return [
        replace(tasks[first], frames=tuple(frame for task in tasks[first : first + length] for frame in task.frames))
        for first in range(0, len(tasks), length)
    ]


def still_tasks(
    file: Path, iterations: int, parts: int, outputs: Sequence[Path], folder: Path, options: Sequence[str]
) -> tuple[list[Task], Task]:
    """A still in parts, each with its part of the iterations, and the task that merges them.

    Args:
        file: the scene.
        iterations: of the whole picture.
        parts: how many; each has at least one iteration.
        outputs: the pictures.
        folder: where the parts go, and checkpoints with which another worker goes on with a lost one's part.
        options: of rppm render.
    """
    if parts > iterations:
        raise SettingsError(f"{iterations} samples cannot be shared out in {parts} parts; ask for fewer --parts")
    marks = [iterations * part // parts for part in range(parts + 1)]
    tasks = []
    for first, end in pairwise(marks):
        part = folder / f"{PART}{first}_{end}.exr"
        words = ["--samples-range", f"{first}:{end}", "--checkpoint", str(part.with_suffix(CHECKPOINT))]
        arguments = ("render", str(file), *words, "--resume", *options)
        tasks.append(Task(arguments, (part,), words=f"samples {first} to {end - 1}"))
    merge = Task(("merge", *(str(task.outputs[0]) for task in tasks)), tuple(outputs), words="merge")
    return tasks, merge
