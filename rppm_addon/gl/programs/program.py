# SPDX-License-Identifier: GPL-3.0-or-later
"""Compute and draw programs, run with named buffers and one block of parameters."""

import functools
import math
import struct
from collections.abc import Callable, Mapping
from typing import Any

import moderngl

from ...scene.errors import DeviceError
from ..buffers.buffers import BufferRange
from ..buffers.constants import Constants
from ..buffers.records import Record
from ..buffers.texel_buffers import IMAGES_FOR_LARGE, MAX_ADDED, TexelBuffers
from ..context.context import Context
from ..context.pacing import Pace, Pacing
from .bindings import ITERATION, PARAMETERS, UNIFORM_BINDINGS
from .program_maker import ProgramMaker
from .sources import Source

_EMPTY_COMPUTE = "#version 430 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n"
_EMPTY_VERTEX = "#version 430 core\nvoid main() { gl_Position = vec4(0.0); }\n"
_EMPTY_FRAGMENT = "#version 430 core\nvoid main() {}\n"
GROUP_SIZE = 64
"""Threads of a group, where shaders count groups."""
GROUPS_PER_ROW = 65535
"""Groups of a dispatch along an axis that every device allows."""
_QUAD = 6
"""Vertices of two triangles: draws are cut between them."""
FIRST_INVOCATION, DRIVER_THREADS = "first_invocation", "driver_threads"
"""The uniforms at locations 0 and 1: the first that programs which can be run in pieces have, the second that those of
them have which deal their groups to a driver's threads (shaders/common/invocation.glsl)."""
Block = moderngl.Buffer | BufferRange
"""Buffer, or range of one, that is bound as a storage block."""
Bindable = Block | moderngl.Texture
"""Object that is bound by name: a storage block, or the texture of a sampler."""
Parameters = Mapping | bytes
"""Values of the members of a program's record of parameters, or the record packed (Record.pack)."""
Constants("Dispatch", GROUP_SIZE=GROUP_SIZE, GROUPS_PER_ROW=GROUPS_PER_ROW)


class Program:
    """Base class of compute and draw programs: bindings by block name, texel buffers, and the parameter block."""

    def __init__(self, context: Context, pacing: Pacing, sources: list[Source]) -> None:
        self.context = context
        self._pacing = pacing
        self._pace = Pace()
        self.before_first_run: Callable[[], None] | None = None
        self.before_dispatch: Callable[[], None] | None = None
        """Called once, when all is bound."""
        self.name = " + ".join(source.files[0] for source in sources)
        self.sources = sources
        self._bindings: dict[str, int] = {}
        self._textures: dict[str, int] = {}
        self.record: Record | None = None
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
        block, texels = self.context.storage_block_limit, self.context.max_texels
        most = dict.fromkeys(self._bindings, block) | {name: texels * size for name, size in self._texel_bytes.items()}
        return frozenset(
            name for name, limit in most.items() if name in buffers and buffers[name].size > limit + MAX_ADDED
        )

    def _bind(self, buffers: Mapping[str, Any], parameters: Parameters | None) -> None:
        if self.before_first_run is not None:
            self.before_first_run()
            self.before_first_run = None
        if missing := self.blocks - buffers.keys():
            raise ValueError(
                f"{self.name}: buffers missing {sorted(missing)}; pass the blocks of the StageContext and of the stage"
            )
        for block, binding in self._bindings.items():
            buffers[block].bind_to_storage_buffer(binding)
        for sampler, unit in self._textures.items():
            buffers[sampler].use(unit)
        if ITERATION in self.blocks:
            buffers[ITERATION].bind_to_uniform_block(UNIFORM_BINDINGS[ITERATION])
        if self._texel_buffers is not None:
            self._texel_buffers.bind(buffers)
        if self._parameters is not None and self.record is not None:
            packed = parameters if isinstance(parameters, bytes) else self.record.pack(dict(parameters or {}))
            self._parameters.write(packed)
            self._parameters.bind_to_uniform_block(UNIFORM_BINDINGS[PARAMETERS])
        if self.before_dispatch is not None:
            self.before_dispatch()
            self.before_dispatch = None

    def release(self) -> None:
        """Free what it has on the device."""
        if self._parameters is not None:
            self._parameters.release()


class ComputeProgram(Program):
    """A compute shader."""

    def __init__(self, context: Context, maker: ProgramMaker, source: Source, links_later: bool) -> None:
        """links_later: where others may compile it in the background, it is linked when it is first run, and what is
        wrong with it is raised then."""
        super().__init__(context, maker.pacing, [source])
        self._set_uniform = maker.set_uniform
        self._is_divisible = FIRST_INVOCATION in source.text
        self._lacks_threads = DRIVER_THREADS in source.text
        """Flag that stays set until the program, once it is linked, is given the uniform DRIVER_THREADS."""
        self.local_size = source.local_size
        self._program = context.moderngl.compute_shader(_EMPTY_COMPUTE)
        self.before_dispatch = maker.begin(self._program.glo, source, links_later)

    def run(self, threads: int, buffers: Mapping[str, Bindable], parameters: Parameters | None = None) -> None:
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
        parameters: Parameters | None = None,
    ) -> None:
        """Run as many groups as three uints at byte ``offset`` of ``arguments`` say."""
        if (other := self._for_large(buffers)) is not None:
            other.run_indirect(arguments, offset, buffers, parameters)
            return

        groups = functools.partial(_groups_of, arguments, offset)
        if self.context.is_software:  # has computed the arguments already: what runs for nothing is not even bound
            count = groups()
            if count == 0:
                return
            groups = functools.partial(int, count)
        self._bind(buffers, parameters)
        self._run(groups, lambda: self._program.run_indirect(arguments, offset))

    def _run(self, groups: Callable[[], int], whole: Callable[[], None]) -> None:
        """Run the program with what is bound, in pieces where it takes long, and order the writes."""
        if self._lacks_threads:
            self._set_uniform(self._program.glo, 1, self.context.driver_threads)
            self._lacks_threads = False
        if self._is_divisible:
            self._pacing.run(self._pace, groups, whole, self._run_groups)
        else:
            whole()
        self.context.barrier()

    def _run_groups(self, first: int, count: int) -> None:
        """Run a number of groups from a first one on, without those that would only fill a row."""
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


class DrawProgram(Program):
    """A vertex and a fragment shader; vertices are pulled from storage blocks."""

    def __init__(self, context: Context, maker: ProgramMaker, vertex: Source, fragment: Source) -> None:
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
        parameters: Parameters | None = None,
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


def _groups_of(arguments: moderngl.Buffer, offset: int) -> int:
    """Return the number of groups that an indirect dispatch asks for. Waits for the device."""
    return math.prod(struct.unpack("=3I", arguments.read(12, offset=offset)))


def _quads_of(command: moderngl.Buffer) -> int:
    """Return the number of quads that an indirect draw command asks for. Waits for the device."""
    return struct.unpack("=I", command.read(4))[0] // _QUAD
