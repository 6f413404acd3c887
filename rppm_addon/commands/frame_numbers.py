# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame numbers on the command line, and in the names of pictures."""

import re
from pathlib import Path

from ..scene.errors import SettingsError

_RANGE = re.compile(r"(-?\d+)(?:\.\.(-?\d+)(?:\.\.(\d+))?)?")


def frame_numbers(text: str) -> tuple[int, ...]:
    """Frames of ``1..100``, ``1..100..5`` (each fifth), ``7`` and lists of these with commas, each once, in order.

    Raises ValueError.
    """
    frames: dict[int, None] = {}
    for item in text.split(","):
        match = _RANGE.fullmatch(item.strip())
        if match is None:
            raise ValueError(f"{item!r} is no range of frames")
        first, last, step = (int(group) if group else None for group in match.groups())
        frames.update(dict.fromkeys(range(first, (first if last is None else last) + 1, 1 if step is None else step)))
    if not frames:
        raise ValueError(f"{text!r} holds no frame")
    return tuple(frames)


def frame_path(pattern: Path, frame: int) -> Path:
    """The picture of a frame: the last row of # in the name becomes its number, as in Blender.

    Raises SettingsError when there is none.
    """
    end = pattern.name.rfind("#") + 1
    start = len(pattern.name[:end].rstrip("#"))
    if end == 0:
        raise SettingsError(f"{pattern} is one file for many frames; put #### where the frame's number belongs")
    sign = "-" if frame < 0 else ""
    return pattern.with_name(f"{pattern.name[:start]}{sign}{abs(frame):0{end - start}d}{pattern.name[end:]}")
