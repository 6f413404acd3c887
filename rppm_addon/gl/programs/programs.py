# SPDX-License-Identifier: GPL-3.0-or-later
"""ProgramLibrary: programs from our shader files, each made once."""

import contextlib
import functools
import logging
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import PurePosixPath
from typing import Any, NamedTuple

from ...scene.errors import DeviceError
from ..context.context import Context
from ..context.pacing import Pacing
from .program import ComputeProgram, DrawProgram
from .program_maker import ProgramMaker
from .sources import Source, expand

log = logging.getLogger(__name__)


class CompilationWork(NamedTuple):
    """Work of compiling programs, in letters of their texts, which the time to compile them follows."""

    compiled: int
    known: int
    """Work of all programs made so far."""


class ProgramLibrary:
    """Compiled programs, each made once per set of defines."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self._reads_texels = context.is_software
        self._maker = ProgramMaker(context)
        self._programs: dict[tuple, ComputeProgram | DrawProgram] = {}
        self._sources: dict[tuple, Source] = {}
        """Sources of programs that were expected, by path and inserts."""
        self._scene_defines: dict[str, object] = {}
        self.graph_defines: dict[str, object] = {}
        """Defines of the programs of node graphs, those with inserts, from now on: how they convert colors."""
        self.made = 0
        """Programs that were compiled or taken from the disk so far; asking again for one adds nothing."""
        self.started = 0
        """Programs that have run; llvmpipe for one generates their code only then."""
        self.on_start: Callable[[str], None] | None = None
        """Called with its name before a program runs for the first time; ``started`` counts it already."""

    @contextlib.contextmanager
    def defining(self, defines: Mapping[str, object]) -> Iterator[None]:
        """Have the programs that are made meanwhile know what a scene has, as far as their sources ask for it."""
        before, self._scene_defines = self._scene_defines, dict(defines)
        try:
            yield
        finally:
            self._scene_defines = before

    @property
    def scene_defines(self) -> dict[str, object]:
        """Defines of the scene, for programs that are made now (defining)."""
        return self._scene_defines

    def _defines(self, paths: Sequence[str], defines: Mapping[str, object] | None) -> dict[str, object]:
        """Return the defines of programs of files: those given, and those of the scene that their sources ask for."""
        given = dict(defines or {})
        if not self._scene_defines:
            return given
        texts = [expand(path, given).text for path in paths]
        asked = {key: value for key, value in self._scene_defines.items() if any(key in text for text in texts)}
        return asked | given

    def compute(
        self,
        path: str,
        defines: Mapping[str, object] | None = None,
        inserts: Mapping[str, str] | None = None,
    ) -> ComputeProgram:
        """The compute program of a .comp file; ``inserts`` are texts that stand for files that it includes.

        Raises ShaderError with file and line; CompileError where it is the driver that refuses, without
        ``inserts`` maybe not before the program is first run.
        """
        given = self.graph_defines | dict(defines or {}) if inserts else self._defines([path], defines)
        return self._compute(path, given, dict(inserts or {}))

    def has_stand_in(self, path: str, inserts: Mapping[str, str]) -> bool:
        """Whether a compute program that something can stand in for is still to be compiled, and is, in the background.

        False where there is no core to spare, and once the program is there: then compute() takes no time.
        """
        return self._expect(path, inserts, needed=False)

    def expect(self, path: str, inserts: Mapping[str, str]) -> None:
        """Have a compute program that will soon be asked for compiled in the background meanwhile."""
        self._expect(path, inserts, needed=True)

    def _expect(self, path: str, inserts: Mapping[str, str], needed: bool) -> bool:
        compiler = self._maker.compiler
        if compiler is None or _key(path, self.graph_defines, inserts) in self._programs:
            return False
        source = self._expanded(path, inserts)
        if not compiler.knows(source):
            if self._maker.cache.holds(source.text):  # it has run before, so the driver has its code as well
                return False
            compiler.submit(source, needed)
        return not compiler.has_tried(source)

    def _expanded(self, path: str, inserts: Mapping[str, str]) -> Source:
        """The same object for the same text, so that asking again costs nothing."""
        key = _key(path, self.graph_defines, inserts)
        if key not in self._sources:
            self._sources[key] = expand(path, dict(self.graph_defines), dict(inserts), self._reads_texels)
        return self._sources[key]

    def compilation_work(self) -> CompilationWork:
        """Return the work of the programs so far: compiled are those that have run, or were tried in the background."""
        compiler, compiled, known = self._maker.compiler, 0, 0
        for program in self._programs.values():
            length = sum(len(source.text) for source in program.sources)
            known += length
            is_compiled = program.before_first_run is None or (
                compiler is not None and all(map(compiler.has_tried, program.sources))
            )
            compiled += length if is_compiled else 0
        return CompilationWork(compiled, known)

    @property
    def pacing(self) -> Pacing:
        """Pacing by which programs are run."""
        return self._maker.pacing

    def hurry(self, hurries: bool) -> None:
        """Whether anybody waits for what is compiled in the background."""
        if self._maker.compiler is not None:
            self._maker.compiler.hurry(hurries)

    def draw(self, vertex: str, fragment: str, defines: Mapping[str, object] | None = None) -> DrawProgram:
        """The program of a .vert and a .frag file. Raises ShaderError with file and line."""
        return self._draw(vertex, fragment, self._defines([vertex, fragment], defines))

    def _get(self, key: tuple, make: Callable[[], Any]) -> Any:
        if key not in self._programs:
            start = time.perf_counter()
            self._programs[key] = make()
            self._programs[key].before_first_run = functools.partial(self._start, _name(key[0]))
            self.made += 1
            log.debug("%s ready in %.3f s", key[0], time.perf_counter() - start)
        return self._programs[key]

    def _start(self, name: str) -> None:
        self.started += 1
        if self.on_start is not None:
            self.on_start(name)

    def _compute(self, path: str, defines: dict, inserts: dict, large: frozenset[str] = frozenset()) -> ComputeProgram:
        key = _key(path, defines, inserts)

        def make() -> ComputeProgram:
            expected = None if large else self._sources.get(key)
            source = expected or expand(path, defines, inserts, self._reads_texels, large)
            program = ComputeProgram(self.context, self._maker, source, links_later=not inserts)
            if not large:
                program.with_large = functools.partial(self._compute, path, defines, inserts)
            return program

        return self._get((*key, *sorted(large)), make)

    def _draw(self, vertex: str, fragment: str, defines: dict, large: frozenset[str] = frozenset()) -> DrawProgram:
        def make() -> DrawProgram:
            if len(large) > self.context.vertex_images:
                raise DeviceError(
                    f"{vertex} takes more of {', '.join(sorted(large))} at once than the device "
                    f"{self.context.information.name} allows; simplify the scene, or choose another device"
                )
            vertex_source = expand(vertex, defines, large=large)
            fragment_source = expand(fragment, defines, large=large, beside=vertex_source)
            program = DrawProgram(self.context, self._maker, vertex_source, fragment_source)
            if not large:
                program.with_large = functools.partial(self._draw, vertex, fragment, defines)
            return program

        return self._get((vertex, fragment, tuple(sorted(defines.items())), *sorted(large)), make)

    def release(self) -> None:
        """Free what it has on the device."""
        self._maker.release()
        for program in self._programs.values():
            program.release()
        self._programs.clear()


def _key(path: str, defines: Mapping[str, object], inserts: Mapping[str, str]) -> tuple:
    """Key of a compute program."""
    return path, tuple(sorted(defines.items())), tuple(sorted(inserts.items()))


def _name(path: str) -> str:
    """Name of a program for users: "importons, scatter" for camera_paths/importons/scatter.comp."""
    return ", ".join(dict.fromkeys(PurePosixPath(path).with_suffix("").parts[-2:])).replace("_", " ")
