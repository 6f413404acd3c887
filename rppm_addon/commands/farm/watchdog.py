# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends a render whose worker has gone, so that none outlives the farm that it belongs to."""

import _thread
import os
import signal
import threading
import time

from ..terminal.interruption import INTERRUPTED

STANDARD_INPUT = 0
"""Its number for the system, whatever sys.stdin is."""
BETWEEN_INTERRUPTS_SECONDS = 5.0
"""The first has the render write its checkpoint and end, the second ends it wherever it is."""
TIMEOUT_SECONDS = 10.0
"""Blender's own code may not hear interrupts; after so long the process ends regardless."""


def watch_parent() -> None:
    """End this process as by Ctrl-C pressed twice once the worker lets go of the other end of standard input, or is
    killed and cannot say so."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # the worker may have handed on that it ignores Ctrl-C
    threading.Thread(target=_end_when_released, daemon=True).start()


def _end_when_released() -> None:
    while os.read(STANDARD_INPUT, 1024):
        pass
    for _ in range(2):
        _thread.interrupt_main()
        time.sleep(BETWEEN_INTERRUPTS_SECONDS)
    time.sleep(TIMEOUT_SECONDS)
    os._exit(INTERRUPTED)
