# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender without a window, as farm managers run it: options behind ``--``, and an exit status for lost frames."""

import argparse
import atexit
import contextlib
import ctypes
import logging
import os
import shutil
import sys
from collections.abc import Sequence

import bpy

logger = logging.getLogger(__name__)

FAILED = 1
"""Exit status of a Blender that has lost a frame, unless --python-exit-code says another."""
_lost_frames = False


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


def lose_frame() -> None:
    """A frame has no picture: a Blender in the background will end with another status than 0."""
    global _lost_frames
    _lost_frames = True


def failure_status(arguments: Sequence[str]) -> int:
    """The exit status for lost frames by Blender's command line."""
    with contextlib.suppress(ValueError, IndexError):
        return int(arguments[list(arguments).index("--python-exit-code") + 1]) or FAILED
    return FAILED


def _end() -> None:
    """Blender knows no way to end otherwise than well once an animation is rendered. All files are written by now."""
    # As a module Blender is a guest in another program, whose status is its own.
    if not (_lost_frames and bpy.app.background and bpy.app.binary_path):
        return
    shutil.rmtree(bpy.app.tempdir, ignore_errors=True)
    sys.stdout.flush()
    sys.stderr.flush()
    # What Blender itself has printed.
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None).fflush(None)
    os._exit(failure_status(sys.argv))


atexit.register(_end)  # the first one registered is the last one called


def register() -> None:
    """Take the options that Blender was started with."""
    read_options(sys.argv)
