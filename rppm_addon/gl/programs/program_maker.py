# SPDX-License-Identifier: GPL-3.0-or-later
"""ProgramMaker: links programs, with what the disk has and what other cores compile meanwhile."""

import ctypes
import functools
from collections.abc import Callable

from ..context.context import Context
from ..context.pacing import Pacing
from .background_compiler import BackgroundCompiler, CompilerContext, EmptyDispatch, can_compile_ahead
from .binary_cache import BinaryCache
from .linking import Linker
from .sources import Source


class ProgramMaker:
    """Links programs, takes them from the disk, or has them compiled while the renderer waits for none of them."""

    def __init__(self, context: Context) -> None:
        self.cache = BinaryCache(context)
        self.pacing = Pacing(context)
        unsigned = ctypes.c_uint
        self.set_uniform = context.function("glProgramUniform1ui", None, unsigned, ctypes.c_int, unsigned)
        """GL function that sets a uint uniform of a program, at a location."""
        self._linker = Linker(context)
        self.compiler: BackgroundCompiler | None = None
        """Compiler in the background; None where no core is to spare."""
        if can_compile_ahead(context, self.cache):
            self.compiler = BackgroundCompiler(lambda: CompilerContext(context.another()))
            self._dispatch = EmptyDispatch(context)

    def make(self, program: int, sources: list[Source]) -> None:
        """Have a GL program linked. Raises CompileError."""
        text = "".join(source.text for source in sources)
        if not self.cache.load(program, text):
            self._linker.link(program, sources)
            self.cache.store(program, text)

    def begin(self, program: int, source: Source, links_later: bool) -> Callable[[], None] | None:
        """Have a compute program linked, or see to it; returns what to call before it is first run, if anything.

        Raises CompileError.
        """
        if self.cache.load(program, source.text):
            return None
        if self.compiler is None:
            self.make(program, [source])
            return None
        if not links_later:
            self.compiler.settle(source)
            self.make(program, [source])
        self.compiler.submit(source)
        return functools.partial(self._finish, self.compiler, program, source, links_later)

    def _finish(self, compiler: BackgroundCompiler, program: int, source: Source, links: bool) -> None:
        """Have the code of a program that is about to be run."""
        compiler.claim(source)
        if links:
            self.make(program, [source])
        self._dispatch.run(program)

    def release(self) -> None:
        """Begin no other program."""
        if self.compiler is not None:
            self.compiler.stop()
            self._dispatch.release()
