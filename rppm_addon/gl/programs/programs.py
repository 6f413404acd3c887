# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs from our shader files, run with named buffers and one block of parameters."""

import contextlib
import ctypes
import functools
import logging
import math
import struct
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import PurePosixPath
from typing import Any

import moderngl

from ...scene.errors import DeviceError
from ..buffers.buffers import BufferRange
from ..buffers.constants import Constants
from ..buffers.texel_buffers import IMAGES_FOR_LARGE, MOST_ADDED, TexelBuffers
from ..context.context import Context
from ..context.pacing import Pace, Pacing
from .background_compiler import BackgroundCompiler, CompilerContext, EmptyDispatch, can_compile_ahead
from .binary_cache import BinaryCache
from .bindings import ITERATION, PARAMETERS, UNIFORM_BINDINGS
from .linking import Linker
from .sources import Source, expand

log = logging.getLogger(__name__)

_EMPTY_COMPUTE = "#version 430 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n"
_EMPTY_VERTEX = "#version 430 core\nvoid main() { gl_Position = vec4(0.0); }\n"
_EMPTY_FRAGMENT = "#version 430 core\nvoid main() {}\n"
GROUP_SIZE = 64
"""Threads of a group, where shaders count groups."""
GROUPS_PER_ROW = 65535
"""Groups of a dispatch along an axis that every device allows."""
_QUAD = 6
"""Vertices of two triangles: draws are cut between them."""
FIRST_INVOCATION = "first_invocation"
"""The uniform at location 0 that programs which can be run in pieces have (shaders/common/invocation.glsl)."""
Block = moderngl.Buffer | BufferRange
"""Buffer, or range of one, that is bound as a storage block."""
Bindable = Block | moderngl.Texture
"""Object that is bound by name: a storage block, or the texture of a sampler."""
Constants("Dispatch", GROUP_SIZE=GROUP_SIZE, GROUPS_PER_ROW=GROUPS_PER_ROW)


class _Program:
    """Base class of compute and draw programs: bindings by block name, texel buffers, and the parameter block."""

    def __init__(self, context: Context, pacing: Pacing, sources: list[Source]) -> None:
        self.context = context
        self._pacing = pacing
        self._pace = Pace()
        self.before_first_run: Callable[[], None] | None = None
        self.before_dispatch: Callable[[], None] | None = None
        """Called once, when all is bound."""
        self.name = " + ".join(source.files[0] for source in sources)
        self._bindings: dict[str, int] = {}
        self._textures: dict[str, int] = {}
        self.record = None
        for source in sources:
            self._bindings |= source.blocks
            self._textures |= source.textures
            self.record = self.record or source.parameters
        uniform_blocks = {ITERATION} if any(source.reads_iteration for source in sources) else set()
        self.with_large: Callable[[frozenset[str]], Any] | None = None
        """The program that reads the blocks of these names as texels, as far as it can."""
        texel_buffers = {name: buffer for source in sources for name, buffer in source.texel_buffers.items()}
        self._texel_bytes = {name: buffer.texel_bytes for name, buffer in texel_buffers.items()}
        self._texel_buffers = TexelBuffers(context, texel_buffers) if texel_buffers else None
        self.blocks = frozenset(self._bindings) | self._textures.keys() | texel_buffers.keys() | uniform_blocks
        """Names of the storage blocks, textures and shared uniform blocks that it reads and writes."""
        self._parameters = context.moderngl.buffer(reserve=self.record.size) if self.record else None

    def _for_large(self, buffers: Mapping[str, Any]) -> Any:
        """The program that is to be run in place of this one, as blocks are too large for it; None if none is.

        Raises DeviceError where there is none.
        """
        large = self.too_large(buffers) if self.context.large_buffers else frozenset()
        if not large:
            return None
        other = self.with_large(large) if self.with_large is not None and len(large) <= IMAGES_FOR_LARGE else None
        if other is None or other.too_large(buffers):
            raise DeviceError(
                f"{self.name} takes more of {', '.join(sorted(large))} at once than the device "
                f"{self.context.information.name} allows; simplify the scene, or choose another device"
            )
        return other

    def too_large(self, buffers: Mapping[str, Any]) -> frozenset[str]:
        """Names of blocks whose buffers are larger than the device allows where the program has them."""
        block, texels = self.context.storage_block_limit, self.context.most_texels
        most = dict.fromkeys(self._bindings, block) | {name: texels * size for name, size in self._texel_bytes.items()}
        return frozenset(
            name for name, limit in most.items() if name in buffers and buffers[name].size > limit + MOST_ADDED
        )

    def _bind(self, buffers: Mapping[str, Any], parameters: Mapping | None) -> None:
        if self.before_first_run is not None:
            self.before_first_run()
            self.before_first_run = None
        if missing := self.blocks - buffers.keys():
            raise ValueError(f"{self.name}: buffers missing {sorted(missing)}")
        for block, binding in self._bindings.items():
            buffers[block].bind_to_storage_buffer(binding)
        for sampler, unit in self._textures.items():
            buffers[sampler].use(unit)
        if ITERATION in self.blocks:
            buffers[ITERATION].bind_to_uniform_block(UNIFORM_BINDINGS[ITERATION])
        if self._texel_buffers is not None:
            self._texel_buffers.bind(buffers)
        if self._parameters is not None:
            self._parameters.write(self.record.pack(dict(parameters or {})))
            self._parameters.bind_to_uniform_block(UNIFORM_BINDINGS[PARAMETERS])
        if self.before_dispatch is not None:
            self.before_dispatch()
            self.before_dispatch = None

    def release(self) -> None:
        """Free what it has on the device."""
        if self._parameters is not None:
            self._parameters.release()


class ComputeProgram(_Program):
    """A compute shader."""

    def __init__(self, context: Context, maker: "ProgramMaker", source: Source, links_later: bool) -> None:
        """links_later: where others may compile it in the background, it is linked when it is first run, and what is
        wrong with it is raised then."""
        super().__init__(context, maker.pacing, [source])
        self._set_uniform = maker.set_uniform
        self._is_divisible = FIRST_INVOCATION in source.text
        self.local_size = source.local_size
        self._program = context.moderngl.compute_shader(_EMPTY_COMPUTE)
        self.before_dispatch = maker.begin(self._program.glo, source, links_later)

    def run(self, threads: int, buffers: Mapping[str, Bindable], parameters: Mapping | None = None) -> None:
        """Run so many threads (rounded up to whole groups) and order their writes."""
        if threads <= 0:
            return
        if (other := self._for_large(buffers)) is not None:
            other.run(threads, buffers, parameters)
            return
        groups = -(-threads // self.local_size)
        rows = -(-groups // GROUPS_PER_ROW)
        self._bind(buffers, parameters)
        self._run(lambda: groups, lambda: self._program.run(min(groups, GROUPS_PER_ROW), rows))

    def run_indirect(
        self,
        arguments: moderngl.Buffer,
        offset: int,
        buffers: Mapping[str, Bindable],
        parameters: Mapping | None = None,
    ) -> None:
        """Run as many groups as three uints at byte ``offset`` of ``arguments`` say."""
        if (other := self._for_large(buffers)) is not None:
            other.run_indirect(arguments, offset, buffers, parameters)
            return

        def groups() -> int:
            return math.prod(struct.unpack("=3I", arguments.read(12, offset=offset)))

        # A driver on the processor has computed the arguments already: what runs for nothing is not even bound.
        if self.context.is_software and groups() == 0:
            return
        self._bind(buffers, parameters)
        self._run(groups, lambda: self._program.run_indirect(arguments, offset))

    def _run(self, groups: Callable[[], int], whole: Callable[[], None]) -> None:
        """Run the program with what is bound, in pieces where it takes long, and order the writes."""
        if self._is_divisible:
            self._pacing.run(self._pace, groups, whole, self._run_groups)
        else:
            whole()
        self.context.barrier()

    def _run_groups(self, first: int, count: int) -> None:
        """So many groups from a first one on, without those that would only fill a row."""
        while count > 0:
            columns = min(count, GROUPS_PER_ROW)
            self._set_uniform(self._program.glo, 0, first * self.local_size)
            self._program.run(columns, 1)
            first, count = first + columns, count - columns
        self._set_uniform(self._program.glo, 0, 0)

    def release(self) -> None:
        """Free what it has on the device."""
        super().release()
        self._program.release()


class DrawProgram(_Program):
    """A vertex and a fragment shader; vertices are pulled from storage blocks."""

    def __init__(self, context: Context, maker: "ProgramMaker", vertex: Source, fragment: Source) -> None:
        sources = [vertex, fragment]
        super().__init__(context, maker.pacing, sources)
        gl = context.moderngl
        self._program = gl.program(vertex_shader=_EMPTY_VERTEX, fragment_shader=_EMPTY_FRAGMENT)
        maker.make(self._program.glo, sources)
        self._vertex_array = gl.vertex_array(self._program, [])

    def draw(
        self,
        framebuffer: moderngl.Framebuffer,
        vertices: int | moderngl.Buffer,
        buffers: Mapping[str, Bindable],
        parameters: Mapping | None = None,
        viewport: tuple[int, int, int, int] | None = None,
        state: int = moderngl.NOTHING,
        depth_function: str = "<",
    ) -> None:
        """Draw triangles into a framebuffer and order the writes.

        ``vertices`` is their count, or a buffer of one indirect draw command (four uints) of whole quads.
        """
        if (other := self._for_large(buffers)) is not None:
            other.draw(framebuffer, vertices, buffers, parameters, viewport, state, depth_function)
            return
        self._bind(buffers, parameters)
        gl = self.context.moderngl
        framebuffer.use()
        framebuffer.viewport = viewport or (0, 0, framebuffer.width, framebuffer.height)
        gl.enable_only(state)
        gl.depth_func = depth_function
        array = self._vertex_array
        if isinstance(vertices, moderngl.Buffer):
            quads = functools.partial(_quads_of, vertices)
            whole = functools.partial(array.render_indirect, vertices, moderngl.TRIANGLES, count=1)
        else:
            quads = functools.partial(int, -(-vertices // _QUAD))
            whole = functools.partial(array.render, moderngl.TRIANGLES, vertices=vertices)

        def part(first: int, count: int) -> None:
            end = _QUAD * (first + count)
            if not isinstance(vertices, moderngl.Buffer):
                end = min(end, vertices)
            array.render(moderngl.TRIANGLES, first=_QUAD * first, vertices=end - _QUAD * first)

        self._pacing.run(self._pace, quads, whole, part)
        self.context.barrier()

    def release(self) -> None:
        """Free what it has on the device."""
        super().release()
        self._vertex_array.release()
        self._program.release()


def _quads_of(command: moderngl.Buffer) -> int:
    """Return the number of quads that an indirect draw command asks for. Waits for the device."""
    return struct.unpack("=I", command.read(4))[0] // _QUAD


def _name(path: str) -> str:
    """A program's, for people: surfaces/resolve/resolve.comp is "resolve", film/film/passes.comp "film, passes"."""
    return ", ".join(dict.fromkeys(PurePosixPath(path).with_suffix("").parts[-2:])).replace("_", " ")


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
        """Where there is a core to spare."""
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
        return lambda: self._finish(program, source, links_later)

    def _finish(self, program: int, source: Source, links: bool) -> None:
        """Have the code of a program that is about to be run."""
        self.compiler.claim(source)
        if links:
            self.make(program, [source])
        self._dispatch.run(program)

    def release(self) -> None:
        """Begin no other program."""
        if self.compiler is not None:
            self.compiler.stop()
            self._dispatch.release()


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
        return self._compute(
            path, dict(defines or {}) if inserts else self._defines([path], defines), dict(inserts or {})
        )

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
        if compiler is None or (path, (), tuple(sorted(inserts.items()))) in self._programs:
            return False
        source = self._expanded(path, inserts)
        if not compiler.knows(source):
            if self._maker.cache.holds(source.text):  # it has run before, so the driver has its code as well
                return False
            compiler.submit(source, needed)
        return not compiler.has_tried(source)

    def _expanded(self, path: str, inserts: Mapping[str, str]) -> Source:
        """The same object for the same text, so that asking again costs nothing."""
        key = (path, *sorted(inserts.items()))
        if key not in self._sources:
            self._sources[key] = expand(path, {}, dict(inserts), self._reads_texels)
        return self._sources[key]

    @property
    def pacing(self) -> Pacing:
        """How programs are run."""
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
        def make() -> ComputeProgram:
            source = expand(path, defines, inserts, self._reads_texels, large)
            program = ComputeProgram(self.context, self._maker, source, links_later=not inserts)
            if not large:
                program.with_large = functools.partial(self._compute, path, defines, inserts)
            return program

        return self._get((path, *(tuple(sorted(given.items())) for given in (defines, inserts)), *sorted(large)), make)

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
