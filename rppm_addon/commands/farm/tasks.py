# SPDX-License-Identifier: GPL-3.0-or-later
"""What a farm hands out: one call of the rppm program, and the pictures that it makes."""

import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from ...pictures import is_whole
from ...scene.errors import SettingsError
from ..frame_numbers import path_of_frame

PART = "iterations_"
"""Begins the names of the parts of a still and of their checkpoints."""


@dataclass(frozen=True)
class Task:
    """One call of the program."""

    name: str
    """As the user is told: ``frame 7``."""
    arguments: tuple[str, ...]
    """Of rppm, but for the outputs."""
    outputs: tuple[Path, ...]
    """The pictures. The task is done when all are there and whole."""

    @property
    def done(self) -> bool:
        """Whether all pictures can be read to their end."""
        return all(is_whole(path) for path in self.outputs)

    def command(self, outputs: Sequence[Path]) -> list[str]:
        """The arguments of rppm with the pictures under other names."""
        return [*self.arguments, *(word for path in outputs for word in ("-o", str(path)))]

    @property
    def command_line(self) -> str:
        """What a user would type to do the same."""
        return shlex.join(["rppm", *self.command(self.outputs)])


def animation_tasks(file: Path, frames: Sequence[int], outputs: Sequence[Path], options: Sequence[str]) -> list[Task]:
    """A task for each frame; ``options`` are those of rppm render."""
    return [
        Task(
            f"frame {frame}",
            ("render", str(file), "--frame", str(frame), *options),
            tuple(path_of_frame(path, frame) for path in outputs),
        )
        for frame in frames
    ]


def still_tasks(
    file: Path, iterations: int, parts: int, outputs: Sequence[Path], folder: Path, options: Sequence[str]
) -> tuple[list[Task], Task]:
    """A still in parts, each with its share of the iterations, and the task that merges them.

    Args:
        file: the scene.
        iterations: of the whole picture.
        parts: how many; each has at least one iteration.
        outputs: the pictures.
        folder: where the parts go, and checkpoints with which another worker goes on with a lost one's part.
        options: of rppm render.
    """
    if parts > iterations:
        raise SettingsError(f"{iterations} iterations cannot be shared out in {parts} parts; ask for fewer --parts")
    marks = [iterations * part // parts for part in range(parts + 1)]
    tasks = []
    for first, end in pairwise(marks):
        part = folder / f"{PART}{first}_{end}.exr"
        words = ["--iterations-range", f"{first}:{end}", "--checkpoint", str(part.with_suffix(".checkpoint.exr"))]
        arguments = ("render", str(file), *words, "--resume", *options)
        tasks.append(Task(f"iterations {first} to {end - 1}", arguments, (part,)))
    merge = Task("merge", ("merge", *(str(task.outputs[0]) for task in tasks)), tuple(outputs))
    return tasks, merge
