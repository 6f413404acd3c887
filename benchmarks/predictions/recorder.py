# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory accesses of the programs of an iteration, counted by the programs themselves while they run."""

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs import program, programs
from rppm_addon.gl.programs.sources import Source

from .counting import UNIT, Site, counted

_WORDS = 1 << 16
_TEXTURE_BUFFER, _READ_WRITE, _R32UI = 0x8C2A, 0x88BA, 0x8236


@dataclass
class Asked:
    """Counts of what one program asked for in some iterations."""

    runs: int = 0
    invocations: int = 0
    """Invocations of the program's heaviest stage."""
    asked: dict[Site, int] = field(default_factory=dict)
    """How often, by what was asked."""
    sizes: dict[str, int] = field(default_factory=dict)
    """Bytes of its buffers, the most so far."""


class Recorder:
    """Has programs that are made within ``recording`` count, and adds up by their names.

    Nothing is taken for a software driver there: programs and routes are those of a GPU.
    """

    def __init__(self, context: Context) -> None:
        context.__dict__["is_software"] = False
        self._context = context
        self._buffer = context.moderngl.buffer(reserve=4 * _WORDS)
        self._sites: dict[str, tuple[int, list[Site]]] = {}
        """First word and sites by the text of a source."""
        self._sources: dict[str, list[str]] = {}
        """Texts by the names of programs."""
        self._runs: dict[str, int] = {}
        self._sizes: dict[str, dict[str, int]] = {}
        self._words = 0
        self._bind_counts()

    def _bind_counts(self) -> None:
        unsigned, integer = ctypes.c_uint, ctypes.c_int
        function, texture = self._context.function, ctypes.c_uint(0)
        function("glGenTextures", None, integer, ctypes.POINTER(unsigned))(1, ctypes.byref(texture))
        function("glBindTexture", None, unsigned, unsigned)(_TEXTURE_BUFFER, texture.value)
        function("glTexBuffer", None, unsigned, unsigned, unsigned)(_TEXTURE_BUFFER, _R32UI, self._buffer.glo)
        bind = function(
            "glBindImageTexture", None, unsigned, unsigned, integer, ctypes.c_ubyte, integer, unsigned, unsigned
        )
        bind(UNIT, texture.value, 0, 0, 0, _READ_WRITE, _R32UI)

    @contextmanager
    def recording(self) -> Iterator[None]:
        """Programs that are made count, and those that run are noted."""
        expand, bind = programs.expand, program.Program._bind

        def expand_counted(*arguments: object, **named: object) -> Source:
            source = expand(*arguments, **named)  # type: ignore[arg-type]
            if source.text not in self._sites:
                text, sites = counted(source.text, self._words)
                self._sites[source.text] = self._words, sites
                self._sites[text] = self._words, sites
                self._words += len(sites)
                assert self._words <= _WORDS
                source.text = text
            return source

        def bind_noted(program, buffers, parameters) -> None:  # type: ignore[no-untyped-def]
            self._runs[program.name] = self._runs.get(program.name, 0) + 1
            sizes = self._sizes.setdefault(program.name, {})
            for block in program.blocks:
                sizes[block] = max(sizes.get(block, 0), buffers[block].size)
            bind(program, buffers, parameters)

        made = program.Program.__init__

        def init_noted(program, context, pacing, sources) -> None:  # type: ignore[no-untyped-def]
            made(program, context, pacing, sources)
            texts = self._sources.setdefault(program.name, [])
            texts += [source.text for source in sources if source.text not in texts]

        programs.expand, program.Program._bind, program.Program.__init__ = expand_counted, bind_noted, init_noted
        try:
            yield
        finally:
            programs.expand, program.Program._bind, program.Program.__init__ = expand, bind, made

    def reset(self) -> None:
        """Count from 0 again."""
        self._buffer.clear()
        self._runs.clear()
        self._sizes.clear()

    def read(self) -> dict[str, Asked]:
        """By program, what was asked since the last reset."""
        words = np.frombuffer(self._buffer.read(), np.uint32)
        found = {}
        for name, runs in self._runs.items():
            asked = Asked(runs, sizes=dict(self._sizes[name]))
            for text in self._sources[name]:
                first, sites = self._sites[text]
                for site, count in zip(sites, words[first : first + len(sites)].tolist(), strict=True):
                    if site.kind == "invocations":
                        asked.invocations = max(asked.invocations, count)
                    elif count:
                        asked.asked[site] = asked.asked.get(site, 0) + count
            found[name] = asked
        return found
