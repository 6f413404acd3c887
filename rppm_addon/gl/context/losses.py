# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the driver has reset the device: a context does nothing more then, and what is read in it is no picture."""

import ctypes
from collections.abc import Callable

from ...scene.errors import DeviceLostError
from .driver_errors import CONTEXT_LOST, DriverErrors

_CAUSES = {0x8253: "because of RPPM's work", 0x8254: "because of another program's work"}
"""Causes of a reset, by the value of glGetGraphicsResetStatus."""
_ROBUSTNESS = frozenset(("GL_KHR_robustness", "GL_ARB_robustness"))
_ROBUST_VERSION = 450


class LossWatch:
    """Asks the driver, by its word about resets where it has one, else by the error that follows them."""

    def __init__(self, function: Callable, errors: DriverErrors, version: int, extensions: set[str]) -> None:
        """function: Context.function; version: such as 430."""
        self._errors = errors
        self._status: Callable[[], int] | None = None
        if version >= _ROBUST_VERSION or "GL_KHR_robustness" in extensions:
            self._status = function("glGetGraphicsResetStatus", ctypes.c_uint)
        if self._status is None and extensions & _ROBUSTNESS:
            self._status = function("glGetGraphicsResetStatusARB", ctypes.c_uint)

    def check(self) -> None:
        """Raise DeviceLostError where the context is lost."""
        status = self._status() if self._status is not None else 0
        if status or (self._status is None and self._errors.take(CONTEXT_LOST)):
            cause = _CAUSES.get(status, "as happens when it is busy for too long, sleeps or gets another driver")
            raise DeviceLostError(f"the driver has reset the graphics device, {cause}; what was on it is lost")
