# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of the paths that still go on, so that each segment costs what its active paths cost."""

from collections.abc import Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, Count, Declared
from ...gl.buffers.buffers import SMALLEST, GrowingBuffer, refuse_large_block
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import GROUP_SIZE, GROUPS_PER_ROW, Bindable, ComputeProgram
from ...gl.programs.programs import ProgramLibrary

ACTIVE_PATHS_HEADER = Record(
    "ActivePathsHeader",
    first="uint",
    count="uint",
    unused0="uint",
    unused1="uint",
    groups="uvec3",
    unused2="uint",
)
"""Header of a list of paths: their ``count``, and the ``groups`` of a dispatch over them.

The header is laid out as a range of shaders/surfaces/resolve/ranges.glsl, and ``first`` is the word where the numbers
of the paths begin. A list can therefore stand for the order of the hits where one program resolves them all.
"""
StorageBlock("KeptPaths", "ActivePathsHeader kept; uint kept_paths[];")


Record("CountParameters", count="uint")

SEGMENTS_AT_ONCE = 4
"""Segments between two readings of the number of active paths from a GPU, each of which waits for the GPU."""
_GROUPS = ACTIVE_PATHS_HEADER.offset("groups")
_FIRST = ACTIVE_PATHS_HEADER.size // 4


class ActivePaths(BufferSet):
    """The numbers of active paths, with the arguments of the dispatches over them, on the device.

    A list begins with all paths; each segment keeps those whose rays are to be traced. Programs over the paths of a
    list include shaders/common/active_paths.glsl. The order of a list is nearly that of the numbers and changes no
    picture. Paths that are not on the list keep what they left in their buffers: nothing may read it.
    """

    def __init__(self, context: Context, library: ProgramLibrary, name: str, remedy: str) -> None:
        super().__init__(context, library)
        self._context = context
        self._fill = library.compute("common/active_paths/fill.comp")
        self._keep = library.compute("common/active_paths/keep.comp")
        self._lists = [self.own(GrowingBuffer(context, name, remedy))]
        """The list, and where there is to be ``keep``, room for the next one."""
        self.capacity = 0
        """Largest number of paths that the list may have: as many as it began with."""
        self._bound = self._asked = 0
        """Result of the last call of ``bound``, and the segment in which the device was read for it."""

    @property
    def buffer(self) -> moderngl.Buffer:
        """The list: ACTIVE_PATHS_HEADER and the numbers, uint32."""
        return self._lists[0].buffer

    @staticmethod
    def size(paths: int) -> int:
        """Bytes of a list of so many paths."""
        return ACTIVE_PATHS_HEADER.size + 4 * paths

    def require(self, paths: int, to_keep: bool = False) -> None:
        """Make room for a number of paths, and for ``keep`` to leave some of them out; what was listed is gone.

        Raises DeviceError.
        """
        if to_keep and len(self._lists) == 1:
            first = self._lists[0]
            self._lists.append(self.own(GrowingBuffer(self._context, first.name, first.remedy)))
        for buffer in self._lists:
            buffer.require(self.size(paths))

    def fill(self, paths: int) -> None:
        """List the paths from 0 to below ``paths``."""
        self.require(paths)
        self.capacity = self._bound = paths
        self._asked = 0
        groups = -(-paths // GROUP_SIZE)
        self._begin(self._lists[0], paths, (min(groups, GROUPS_PER_ROW), -(-groups // GROUPS_PER_ROW), 1))
        self._fill.run(paths, {"KeptPaths": self.buffer}, {"count": paths})

    def begin(self, capacity: int) -> None:
        """Empty the list, for a program to list up to ``capacity`` paths (shaders/common/active_paths/kept.glsl)."""
        self.require(capacity)
        self.capacity = capacity
        self._begin(self._lists[0], 0, (0, 0, 1))

    def keep(self, rays: moderngl.Buffer) -> None:
        """Leave out the paths whose rays (RAY, by path) are inactive; room for that must have been required."""
        self._keep_of(self, self._lists[1], rays)
        self._lists.reverse()

    def take(self, paths: "ActivePaths", rays: moderngl.Buffer) -> None:
        """List those of another list's paths whose rays (RAY, by path) are active."""
        self.require(paths.capacity)
        self.capacity = paths.capacity
        self._keep_of(paths, self._lists[0], rays)

    def _keep_of(self, paths: "ActivePaths", kept: GrowingBuffer, rays: moderngl.Buffer) -> None:
        self._begin(kept, 0, (0, 0, 1))
        paths.run(self._keep, {"Rays": rays, "KeptPaths": kept.buffer})

    @staticmethod
    def _begin(paths: GrowingBuffer, count: int, groups: tuple[int, int, int]) -> None:
        header = ACTIVE_PATHS_HEADER.zeros(1)
        header["first"], header["count"], header["groups"] = _FIRST, count, groups
        paths.write(header)

    def run(self, program: ComputeProgram, buffers: Mapping[str, Bindable], parameters: Mapping | None = None) -> None:
        """Run a program for the paths of the list."""
        program.run_indirect(self.buffer, _GROUPS, {**buffers, "ActivePaths": self.buffer}, parameters)

    @property
    def known_empty(self) -> bool:
        """Whether the list is empty, where that is known at no cost.

        A software driver has always finished its work. Waiting for a GPU would take longer than empty dispatches.
        """
        return self._context.is_software and self.read_count() == 0

    def bound(self, segment: int) -> int:
        """Upper bound of the number of paths of a filled list in a segment; 0 once the list is known to be empty.

        Call it in every segment. The bound is exact on a software driver; a GPU is read every few segments
        (SEGMENTS_AT_ONCE).
        """
        if segment != self._asked and (self._context.is_software or segment % SEGMENTS_AT_ONCE == 0):
            self._bound, self._asked = self.read_count(), segment
        return self._bound

    @property
    def known_count(self) -> int:
        """Number of listed paths where that is known at no cost, else ``capacity``."""
        return self.read_count() if self._context.is_software else self.capacity

    def read_count(self) -> int:
        """Number of listed paths. Waits for the device."""
        return int(self._lists[0].read(ACTIVE_PATHS_HEADER.dtype, 1)["count"][0])

    def read(self) -> np.ndarray:
        """(count,) uint32 numbers of the listed paths. Waits for the device."""
        return self._lists[0].read(np.uint32, self.read_count(), ACTIVE_PATHS_HEADER.size)


class PathList(Declared[ActivePaths]):
    """Declares a list of up to ``count`` paths; to_keep: ``keep`` will leave some of them out."""

    def __init__(self, name: str, count: Count | None = None, to_keep: bool = False, remedy: str | None = None) -> None:
        self._name, self._count, self._to_keep, self._remedy = name, count, to_keep, remedy

    def make(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> ActivePaths:
        """Declared.make."""
        paths = ActivePaths(context, library, self._name, self._remedy or remedy)
        if self._count is not None:
            paths.require(self._count(sizes), self._to_keep)
        return paths

    def make_empty(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> ActivePaths:
        """Declared.make_empty."""
        return ActivePaths(context, library, self._name, self._remedy or remedy)

    def expected_bytes(self, sizes: object) -> dict[str, int]:
        """Declared.expected_bytes."""
        lists = 2 if self._to_keep else 1
        return {} if self._count is None else {self._name: lists * max(ActivePaths.size(self._count(sizes)), SMALLEST)}

    def refuse_large(self, context: Context, sizes: object, remedy: str) -> None:
        """Declared.refuse_large; of two lists each may be as large."""
        if self._count is not None:
            refuse_large_block(context, self._name, ActivePaths.size(self._count(sizes)), self._remedy or remedy)
