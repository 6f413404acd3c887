# SPDX-License-Identifier: GPL-3.0-or-later
"""Compute programs compiled on the processor's other cores, ahead of their first run.

Mesa's llvmpipe generates a program's code when it is first dispatched: of one picture's programs half a minute of
processor time, in a single thread. What another context has compiled it finds in its cache on the disk. So threads with
contexts of their own take the longest programs that wait, while the renderer runs into the others one after the other.
"""

import ctypes
import logging
import os
import threading
import time
from collections.abc import Callable

import moderngl

from ..processors import usable_cores
from .context import Context
from .sources import Source
from .textures import TextureKind

log = logging.getLogger(__name__)

_MOST_THREADS = 3
"""More would find little to do: the longest program takes a fifth of the time of all."""
_KEEPING_SECONDS = 0.1
"""Drivers write their cache from a thread of their own, a little after the program is there."""
_DISPATCH_INDIRECT_BUFFER = 0x90EE


class EmptyDispatch:
    """Runs no groups of a program: its code is generated, and what is bound stays untouched.

    It is called past moderngl, which would keep all other threads of Python waiting meanwhile.
    """

    def __init__(self, context: Context) -> None:
        unsigned = ctypes.c_uint
        self._use = context.function("glUseProgram", None, unsigned)
        self._bind = context.function("glBindBuffer", None, unsigned, unsigned)
        self._dispatch = context.function("glDispatchComputeIndirect", None, ctypes.c_ssize_t)
        self._finish = context.function("glFinish", None)
        self._context = context
        self._no_groups: moderngl.Buffer | None = None

    def run(self, program: int) -> None:
        """Do it with a GL program, the context being current."""
        if self._no_groups is None:
            self._no_groups = self._context.moderngl.buffer(bytes(12))
        self._use(program)
        self._bind(_DISPATCH_INDIRECT_BUFFER, self._no_groups.glo)
        self._dispatch(0)
        self._finish()

    def release(self) -> None:
        """Free what it has on the device."""
        if self._no_groups is not None:
            self._no_groups.release()


def is_of_use(context: Context) -> bool:
    """Whether a driver compiles programs at their first run and keeps them, and there is a core to spare."""
    kept = os.environ.get("MESA_SHADER_CACHE_DISABLE", "").lower() not in {"1", "true", "yes", "y", "t"}
    return context.is_software and kept and usable_cores() > 1


class BackgroundCompiler:
    """Compiles what is submitted until it is claimed, the longest first. Methods run in the renderer's thread."""

    def __init__(self, open_context: Callable[[], Context]) -> None:
        """open_context: opens another context of the renderer's device, in the thread that calls it."""
        self._open_context = open_context
        self._condition = threading.Condition()
        self._waiting: list[Source] = []
        self._compiling: set[str] = set()
        """Their texts."""
        self._threads = 0

    def submit(self, source: Source) -> None:
        """A program that will be run, but not at once."""
        with self._condition:
            self._waiting.append(source)
            if self._threads < min(usable_cores() - 1, _MOST_THREADS):
                self._threads += 1
                threading.Thread(target=self._run, name="RPPM compiler").start()

    def claim(self, source: Source) -> None:
        """The program is about to be run: leave it alone, or be done with it on return."""
        with self._condition:
            if source in self._waiting:
                self._waiting.remove(source)
            self._condition.wait_for(lambda: source.text not in self._compiling)

    def stop(self) -> None:
        """Begin no other program."""
        with self._condition:
            self._waiting.clear()

    def _run(self) -> None:
        """A thread's work, until nothing waits. It only saves time: what fails here is left to the renderer."""
        context = None
        while (source := self._next()) is not None:
            try:
                if context is None:
                    context = self._open_context()
                    for unit, kind in TextureKind.by_unit.items():
                        kind.make(context.moderngl, (1, 1)).use(unit)
                    dispatch = EmptyDispatch(context)
                program = context.moderngl.compute_shader(source.text)
                dispatch.run(program.glo)
                time.sleep(_KEEPING_SECONDS)
                program.release()
            except Exception:
                log.info("%s is not compiled in the background", source.files[0], exc_info=True)
            finally:
                with self._condition:
                    self._compiling.discard(source.text)
                    self._condition.notify_all()
        if context is not None:
            context.release()

    def _next(self) -> Source | None:
        """What to compile; with nothing to do, or once the process is about to end, the thread ends."""
        with self._condition:
            if not self._waiting or not threading.main_thread().is_alive():
                self._threads -= 1
                return None
            source = max(self._waiting, key=lambda waiting: len(waiting.text))
            self._waiting.remove(source)
            self._compiling.add(source.text)
            return source
