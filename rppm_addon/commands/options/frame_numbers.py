# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame numbers of the command line: which ones, and where they go in a file's name."""

import itertools
import re
from collections.abc import Sequence
from pathlib import Path

from ...scene.errors import SettingsError

FIRST_FRAME, LAST_FRAME = -1048574, 1048574
"""First and last frame numbers that Blender allows (MINAFRAME and MAXFRAME)."""
_RANGE = re.compile(r"(-?\d+)(?:\.\.(-?\d+)(?:\.\.(-?\d+))?)?")
_PLACE = re.compile(r"#+(?!.*#)")
"""The last run of #, as Blender has it."""


def frame_numbers(text: str) -> tuple[int, ...]:
    """Frames of ``1..100``, ``1..100..5`` (every fifth), ``1,5,9``, or of such with commas between, in that order.

    Raises SettingsError for anything else, a range that runs backwards, and a frame that is named twice.
    """
    ranges = []
    for item in text.split(","):
        match = _RANGE.fullmatch(item.strip())
        if match is None:
            raise SettingsError(f"{item.strip()!r} names no frames; write 7, 1..100, 1..100..5 or 1,5,9")
        first = int(match[1])
        last = first if match[2] is None else int(match[2])
        step = 1 if match[3] is None else int(match[3])
        if last < first:
            raise SettingsError(f"{item.strip()} ends before it begins; write {last}..{first}")
        if step < 1:
            raise SettingsError(f"{item.strip()} has a step of {step}; 1 or more leads on")
        if first < FIRST_FRAME or last > LAST_FRAME:
            raise SettingsError(f"{item.strip()} is beyond Blender's frames, {FIRST_FRAME} to {LAST_FRAME}")
        ranges.append(range(first, last + 1, step))
    frames = tuple(itertools.chain(*ranges))
    if len(set(frames)) < len(frames):
        twice = next(frame for number, frame in enumerate(frames) if frame in frames[:number])
        raise SettingsError(f"frame {twice} is named twice")
    return frames


def has_place(path: Path) -> bool:
    """Whether a file's name has a place for a frame number."""
    return _PLACE.search(path.name) is not None


def path_of_frame(path: Path, frame: int) -> Path:
    """The path with the frame number in place of the last ``####`` of the file's name, filled up with zeros to that
    length; where there is none, the path as it is."""
    return path.with_name(_PLACE.sub(lambda place: f"{frame:0{len(place[0]) + (frame < 0)}d}", path.name))


def check_places(paths: Sequence[Path], frames: Sequence[int]) -> None:
    """Raise SettingsError when several frames would be written to one file."""
    for path in paths:
        if len(frames) > 1 and not has_place(path):
            name = path.with_name(f"{path.stem}_####{path.suffix}")
            raise SettingsError(f"{len(frames)} frames do not go into one {path}; say where the number goes: -o {name}")
