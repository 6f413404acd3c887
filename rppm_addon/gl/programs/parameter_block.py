# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of a program: one record in a uniform block of its own."""

from collections.abc import Mapping

from ..buffers.records import Record
from ..context.context import Context
from .bindings import PARAMETERS, UNIFORM_BINDINGS


class ParameterBlock:
    """The parameters that a program was last run with, on the device."""

    def __init__(self, context: Context, record: Record) -> None:
        self._record = record
        self._points = context.binding_points
        self._buffer = context.moderngl.buffer(reserve=record.size)
        self._packed = b""

    def bind(self, values: Mapping) -> None:
        """Have the values of all members where the program reads them. Raises as Record.pack does."""
        packed = self._record.pack(values)
        if packed != self._packed:
            self._buffer.write(packed)
            self._packed = packed
        self._points.bind_uniform(UNIFORM_BINDINGS[PARAMETERS], self._buffer)

    def release(self) -> None:
        """Free what it has on the device."""
        self._buffer.release()
