# SPDX-License-Identifier: GPL-3.0-or-later
"""Python's search for garbage, which grows with all that Blender and its add-ons hold."""

import contextlib
import gc
from collections.abc import Iterator


@contextlib.contextmanager
def collector_paused() -> Iterator[None]:
    """For what makes thousands of objects of which none is garbage; also a decorator."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()
