# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender without a window, as farm managers run it: options behind ``--``, and an exit status for lost frames."""

import argparse
import itertools
import logging
import os
import signal
import sys
from collections.abc import Sequence

import bpy
from bpy.app.handlers import persistent

from .app_handlers import add_handlers, remove_handlers

logger = logging.getLogger(__name__)


def read_options(arguments: Sequence[str]) -> None:
    """Take RPPM's options from Blender's command line: --rppm-device DEVICE behind ``--``, which has precedence over
    the environment. What is not RPPM's is left to others."""
    behind = list(arguments)[list(arguments).index("--") + 1 :] if "--" in arguments else []
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False, exit_on_error=False)
    parser.add_argument("--rppm-device", metavar="DEVICE")
    try:
        options, others = parser.parse_known_args(behind)
    except (argparse.ArgumentError, SystemExit):
        logger.warning("--rppm-device needs a device, as rppm info lists them; it is ignored")
        return
    for unknown in (text for text in others if text.startswith("--rppm-")):
        logger.warning("%s is no option of RPPM; there is --rppm-device DEVICE", unknown)
    if options.rppm_device is not None:
        os.environ["RPPM_DEVICE"] = options.rppm_device


def renders_asked(arguments: Sequence[str]) -> int:
    """Return the number of renders that Blender's command line asks for: one for -a, one for each frame of -f."""
    arguments = list(arguments)
    if "--" in arguments:
        arguments = arguments[: arguments.index("--")]
    animations = sum(argument in {"-a", "--render-anim"} for argument in arguments)
    lists = (value for name, value in itertools.pairwise(arguments) if name in {"-f", "--render-frame"})
    return animations + sum(_frame_count(part) for value in lists for part in value.split(","))


def _frame_count(part: str) -> int:
    """Return the number of frames of a part of -f: a frame, or the first and last of some, ``3..4``."""
    first, _, last = part.partition("..")
    try:
        return max(int(last) - int(first) + 1, 1)
    except ValueError:
        return 1


class RenderCount:
    """Counts the renders of Blender's command line, to find the last one."""

    def __init__(self, asked: int) -> None:
        """asked: number of renders on the command line; 0 where a script renders."""
        self._left = asked
        self._has_lost_frames = False

    def lose_frame(self) -> None:
        """Note that a frame has no picture."""
        self._has_lost_frames = True

    def end_render(self) -> bool:
        """Count a render that is complete or cancelled. Returns True once: when no more is left and frames are lost."""
        self._left -= 1
        if self._left > 0 or not self._has_lost_frames:
            return False
        self._has_lost_frames = False
        return True


_count = RenderCount(renders_asked(sys.argv))


def lose_frame() -> None:
    """A frame has no picture: a Blender in the background will end with another status than 0."""
    _count.lose_frame()


@persistent
def _on_end(*_: object) -> None:
    """A render is complete or cancelled. Where it was the last one, lost frames break it off, as Ctrl-C would.

    Blender's exit status is then 1. Broken off earlier, the renders that are left would be cancelled.
    """
    # As a module Blender is a guest in another program, whose status is its own.
    if not (_count.end_render() and bpy.app.background and bpy.app.binary_path):
        return
    logger.warning("frames have no picture: Blender ends with status 1")
    if signal.getsignal(signal.SIGINT) is None:  # Blender's own handler, which ends Blender at the second signal
        signal.raise_signal(signal.SIGINT)


_HANDLERS = ((bpy.app.handlers.render_complete, _on_end), (bpy.app.handlers.render_cancel, _on_end))


def register() -> None:
    """Take the options that Blender was started with, and follow its renders."""
    read_options(sys.argv)
    add_handlers(_HANDLERS)


def unregister() -> None:
    """Follow renders no longer."""
    remove_handlers(_HANDLERS)
