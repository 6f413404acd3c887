# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs compiled and linked past moderngl, which would keep all other threads of Python waiting meanwhile.

So several threads compile at once, each in a context of its own, and whoever stops the renderer is heard.
"""

import ctypes
import logging
import re
from collections.abc import Callable, Sequence
from typing import TypeAlias

from ..context.context import Context
from .sources import CompileError, Source

log = logging.getLogger(__name__)

_KINDS = {".comp": 0x91B9, ".vert": 0x8B31, ".frag": 0x8B30, ".geom": 0x8DD9}
"""GL's kinds of shaders by the suffixes of our files."""
_COMPILE_STATUS, _LINK_STATUS, _INFO_LOG_LENGTH = 0x8B81, 0x8B82, 0x8B84
_MAX_SHADERS = 8
_Function: TypeAlias = Callable[..., None]
_FALSE_ALARM = re.compile(r"warning: `\w+' used uninitialized")
"""Mesa says so of variables of a whole shader where a function stands before the one that sets them."""


class Linker:
    """Compiles and links in one context, which is current in the calling thread."""

    def __init__(self, context: Context) -> None:
        unsigned, integer, text = ctypes.c_uint, ctypes.c_int, ctypes.c_char_p
        integers, identifiers = ctypes.POINTER(integer), ctypes.POINTER(unsigned)
        function = context.function
        self._create_program = function("glCreateProgram", unsigned)
        self._delete_program = function("glDeleteProgram", None, unsigned)
        self._create = function("glCreateShader", unsigned, unsigned)
        self._delete = function("glDeleteShader", None, unsigned)
        self._source = function("glShaderSource", None, unsigned, integer, ctypes.POINTER(text), integers)
        self._compile = function("glCompileShader", None, unsigned)
        self._attached = function("glGetAttachedShaders", None, unsigned, integer, integers, identifiers)
        self._attach = function("glAttachShader", None, unsigned, unsigned)
        self._detach = function("glDetachShader", None, unsigned, unsigned)
        self._link = function("glLinkProgram", None, unsigned)
        self._shader_value = function("glGetShaderiv", None, unsigned, unsigned, integers)
        self._program_value = function("glGetProgramiv", None, unsigned, unsigned, integers)
        self._shader_log = function("glGetShaderInfoLog", None, unsigned, integer, integers, text)
        self._program_log = function("glGetProgramInfoLog", None, unsigned, integer, integers, text)

    def new_program(self) -> int:
        """A GL program without shaders, which moderngl does not know."""
        return self._create_program()

    def delete_program(self, program: int) -> None:
        """Free a program of new_program."""
        self._delete_program(program)

    def link(self, program: int, sources: Sequence[Source]) -> None:
        """Make a GL program of the sources, in place of what it was; what the driver has to say is logged.

        Raises CompileError, with the driver's words by our file names and lines.
        """
        self._detach_all(program)
        shaders = []
        try:
            for source in sources:
                shaders.append(self._compiled(source))
                self._attach(program, shaders[-1])
            self._link(program)
            self._judge(program, sources[0], self._program_value, _LINK_STATUS, self._program_log)
        finally:
            for shader in shaders:
                self._detach(program, shader)
                self._delete(shader)

    def _compiled(self, source: Source) -> int:
        shader = self._create(_KINDS[source.suffix])
        text = source.text.encode()
        self._source(shader, 1, ctypes.byref(ctypes.c_char_p(text)), ctypes.byref(ctypes.c_int(len(text))))
        self._compile(shader)
        try:
            self._judge(shader, source, self._shader_value, _COMPILE_STATUS, self._shader_log)
        except CompileError:
            self._delete(shader)
            raise
        return shader

    def _detach_all(self, program: int) -> None:
        shaders, count = (ctypes.c_uint * _MAX_SHADERS)(), ctypes.c_int(0)
        self._attached(program, _MAX_SHADERS, ctypes.byref(count), shaders)
        for shader in shaders[: count.value]:
            self._detach(program, shader)

    @staticmethod
    def _judge(item: int, source: Source, value_of: _Function, status: int, log_of: _Function) -> None:
        """Log what the driver says of a shader or program, or raise it where that cannot be used."""
        succeeded, length = ctypes.c_int(0), ctypes.c_int(0)
        value_of(item, status, ctypes.byref(succeeded))
        value_of(item, _INFO_LOG_LENGTH, ctypes.byref(length))
        said = ctypes.create_string_buffer(max(length.value, 1))
        log_of(item, len(said), None, said)
        words = source.name_lines(said.value.decode(errors="replace")).strip()
        alarms = [line for line in words.splitlines() if _FALSE_ALARM.search(line) is None]
        if not succeeded.value:
            reason = "\n".join(alarms) or "the driver refuses it without a reason"
            raise CompileError(f"{source.files[0]}: {reason}")
        if words:
            log.log(logging.WARNING if alarms else logging.DEBUG, "%s: %s", source.files[0], words)
