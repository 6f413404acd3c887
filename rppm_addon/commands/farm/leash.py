# SPDX-License-Identifier: GPL-3.0-or-later
"""``python -m rppm_addon.commands.farm.leash ARGUMENTS`` is the rppm program for as long as someone holds its input.

A worker holds the other end of standard input. When the worker lets go, or is killed and cannot say so, the render
ends as by Ctrl-C pressed twice. So no render outlives the farm that it belongs to.
"""

import _thread
import os
import signal
import sys
import threading
import time

from ...cli import INTERRUPTED, main

BETWEEN_INTERRUPTS_SECONDS = 5.0
"""The first has the render write its checkpoint and end, the second ends it wherever it is."""
_LINE_SECONDS = 0.5
"""The worker reads how far the render is."""
PATIENCE_SECONDS = 10.0
"""Blender's own code may not hear interrupts; after so long the process ends regardless."""


def _end_when_released() -> None:
    while os.read(sys.__stdin__.fileno(), 1024):
        pass
    for _ in range(2):
        _thread.interrupt_main()
        time.sleep(BETWEEN_INTERRUPTS_SECONDS)
    time.sleep(PATIENCE_SECONDS)
    os._exit(INTERRUPTED)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # the worker may have handed on that it ignores Ctrl-C
    threading.Thread(target=_end_when_released, daemon=True).start()
    sys.exit(main(line_seconds=_LINE_SECONDS))
