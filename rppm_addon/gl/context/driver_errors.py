# SPDX-License-Identifier: GPL-3.0-or-later
"""The errors that a driver keeps until somebody asks for them."""

import ctypes
from collections.abc import Callable

OUT_OF_MEMORY = 0x0505
CONTEXT_LOST = 0x0507


class DriverErrors:
    """Asks for them on behalf of all: glGetError forgets what it returns, and whoever wants one of them loses the
    others."""

    def __init__(self, function: Callable) -> None:
        """function: Context.function."""
        self._get_error: Callable[[], int] = function("glGetError", ctypes.c_uint)
        self._found: set[int] = set()

    def take(self, code: int) -> bool:
        """Whether there has been such an error since this was last asked."""
        found: set[int] = set()
        while (error := self._get_error()) and error not in found:  # a lost context reports its loss again and again
            found.add(error)
        self._found |= found
        was_found = code in self._found
        self._found.discard(code)
        return was_found
