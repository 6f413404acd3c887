# SPDX-License-Identifier: GPL-3.0-or-later
"""Compute programs compiled on the processor's other cores, ahead of their first run.

Threads with contexts of their own take the longest programs that wait, link them and keep their binaries, while the
renderer runs into the others one after the other. Mesa's llvmpipe generates a program's code when it is first
dispatched: of one picture's programs half a minute of processor time. They do that as well, and the renderer's context
finds the code in Mesa's cache on the disk.
"""

import contextlib
import ctypes
import logging
import os
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

import moderngl

from ...processors import usable_cores
from ..buffers.texel_buffers import TEXEL_SIZE, TexelBuffers, allocated_size
from ..buffers.textures import TextureKind
from ..context.context import Context
from .binary_cache import BinaryCache
from .linking import Linker
from .sources import Source

log = logging.getLogger(__name__)

_MAX_THREADS = 6
"""Beside the renderer's. More would find nothing to do: the longest program takes a seventh of the time of all."""
_KEEPING_SECONDS = 0.1
"""Drivers write their cache from a thread of their own, a little after the program is there."""
_DISPATCH_INDIRECT_BUFFER = 0x90EE
_NICENESS = 10
"""Niceness of a thread whose work nobody waits for."""


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


def can_compile_ahead(context: Context, cache: BinaryCache) -> bool:
    """Whether the renderer's context can have what another one has compiled, and there is a core to spare."""
    kept = os.environ.get("MESA_SHADER_CACHE_DISABLE", "").lower() not in {"1", "true", "yes", "y", "t"}
    return (kept if context.is_software else cache.available) and usable_cores() > 1


class CompilerContext:
    """A context of the calling thread, in which programs are compiled and nothing is run."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._cache, self._linker, self._dispatch = BinaryCache(context), Linker(context), EmptyDispatch(context)
        kinds = TextureKind.by_sampler.items()
        self._textures = {name: kind.make(context.moderngl, (1, 1)) for name, kind in kinds}
        self._texels = context.moderngl.buffer(reserve=allocated_size(TEXEL_SIZE))

    def compile(self, source: Source) -> None:
        """Have a program's binary and, where drivers generate code late, its code. Raises CompileError."""
        program = self._linker.new_program()
        try:
            if not self._cache.load(program, source.text):
                self._linker.link(program, [source])
                self._cache.store(program, source.text)
            for name, unit in source.textures.items():
                if name in self._textures:
                    self._textures[name].use(unit)
            buffers = source.texel_buffers
            TexelBuffers(self._context, buffers).bind(dict.fromkeys(buffers, self._texels))
            self._dispatch.run(program)
            if self._context.is_software:
                time.sleep(_KEEPING_SECONDS)
        finally:
            self._linker.delete_program(program)

    def release(self) -> None:
        """Close the context."""
        self._context.release()


@dataclass(frozen=True)
class _Job:
    source: Source
    needed: bool
    """Whether a picture cannot do without it; what has a stand-in comes later."""

    @property
    def urgency(self) -> tuple[bool, int]:
        """The greatest is next: the longest of those that are needed."""
        return self.needed, len(self.source.text)


class BackgroundCompiler:
    """Compiles what is submitted until it is claimed, the longest first. Methods run in the renderer's thread."""

    def __init__(self, open_context: Callable[[], CompilerContext]) -> None:
        """open_context: opens another context of the renderer's device, in the thread that calls it."""
        self._open_context = open_context
        self._condition = threading.Condition()
        self._waiting: list[_Job] = []
        self._compiling: set[str] = set()
        """Their texts."""
        self._compiled: set[str] = set()
        """Texts of those that were tried."""
        self._threads = {True: 0, False: 0}
        """Counts of threads: those that somebody waits for, and those, one at most, that work at a lower priority."""
        self._hurries = True

    def submit(self, source: Source, needed: bool = True) -> None:
        """A program that will be run, but not at once. needed: not only what has a stand-in."""
        with self._condition:
            if source.text not in self._compiled:
                self._waiting.append(_Job(source, needed))
                self._start_thread()

    def hurry(self, hurries: bool) -> None:
        """Whether anybody waits for what is compiled: if not, a single thread does it at a lower priority."""
        with self._condition:
            self._hurries = hurries
            if self._waiting:
                self._start_thread()

    def has_tried(self, source: Source) -> bool:
        """Whether a program is compiled, or cannot be here."""
        with self._condition:
            return source.text in self._compiled

    def knows(self, source: Source) -> bool:
        """Whether a program has been submitted."""
        with self._condition:
            waiting = any(job.source == source for job in self._waiting)
            return waiting or source.text in self._compiling or source.text in self._compiled

    def _start_thread(self) -> None:
        most = min(usable_cores() - 1, _MAX_THREADS) if self._hurries else 1
        if self._threads[self._hurries] < most:
            self._threads[self._hurries] += 1
            threading.Thread(target=self._run, args=(self._hurries,), name="RPPM compiler").start()

    def settle(self, source: Source) -> None:
        """The program is about to be linked: leave it alone, or be done with it on return. Submit it again after."""
        with self._condition:
            self._waiting = [job for job in self._waiting if job.source != source]
            self._condition.wait_for(lambda: source.text not in self._compiling)

    def claim(self, source: Source) -> None:
        """The program is about to be run: as settle, and for good."""
        self.settle(source)
        with self._condition:
            self._compiled.add(source.text)

    def stop(self) -> None:
        """Begin no other program."""
        with self._condition:
            self._waiting.clear()

    def _run(self, hurries: bool) -> None:
        """A thread's work, until nothing waits. It only saves time: what fails here is left to the renderer."""
        context = None
        if not hurries and sys.platform == "linux":  # where threads have priorities of their own
            with contextlib.suppress(OSError):
                os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)
        while (source := self._next(hurries)) is not None:
            try:
                if context is None:
                    context = self._open_context()
                context.compile(source)
            except Exception:
                log.info("%s is not compiled in the background", source.files[0], exc_info=True)
            finally:
                with self._condition:
                    self._compiling.discard(source.text)
                    self._compiled.add(source.text)
                    self._condition.notify_all()
        if context is not None:
            context.release()

    def _next(self, hurries: bool) -> Source | None:
        """Return the source to compile next; None ends the thread: nothing waits, or the process is about to end."""
        with self._condition:
            if not self._waiting or not threading.main_thread().is_alive():
                self._threads[hurries] -= 1
                return None
            job = max(self._waiting, key=lambda waiting: waiting.urgency)
            self._waiting.remove(job)
            self._compiling.add(job.source.text)
            return job.source
