# SPDX-License-Identifier: GPL-3.0-or-later
"""Started as a script in the renderer's process, by a Python that may be isolated and knows no add-on.

Inside Blender this package is a part of bl_ext, which does not exist here: it is imported by its folder instead.
"""

import contextlib
import ctypes
import faulthandler
import os
import signal
import sys
from pathlib import Path

_PR_SET_PDEATHSIG = 1


def _take_pipes() -> tuple:
    """The pipes to Blender. What the process prints goes to the log from now on, which is standard error."""
    pipes = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    with Path(os.devnull).open("rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    os.dup2(2, 1)
    return pipes


def _yield_to_blender() -> None:
    """Leave the processor to Blender's window, Ctrl-C to Blender, and the stage when Blender dies."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "nice"):
        os.nice(5)
    if sys.platform.startswith("linux"):
        # The end of the pipe says so as well, but is not seen while the driver computes and holds the interpreter.
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


def main() -> int:
    """Answer Blender until it leaves."""
    reader, writer = _take_pipes()
    faulthandler.enable()  # a crash in a driver leaves its traces in the log
    _yield_to_blender()
    here = Path(__file__).resolve()
    sys.path[:] = [str(here.parents[3]), *(folder for folder in sys.path if Path(folder or ".") != here.parent)]
    from rppm_addon.session.transport.protocol import read_message

    hello = read_message(reader)
    if hello is None:
        return 0
    sys.path += [folder for folder in hello["path"] if folder not in sys.path]
    from rppm_addon.wheel_libraries import add_wheel_libraries

    add_wheel_libraries(sys.path)  # before anything is imported that needs them
    from rppm_addon.session.worker.worker import work

    return work(hello, reader, writer)


if __name__ == "__main__":
    # Without tidying up, in which drivers hang or crash.
    os._exit(main())
