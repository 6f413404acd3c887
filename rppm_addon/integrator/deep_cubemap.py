# SPDX-License-Identifier: GPL-3.0-or-later
"""The deep cubemap (DIRT): builds it by rasterization, traces rays through it.

All triangles are sorted into the cells of a cubemap around a centre and, within a cell, by depth.
Building takes four steps, shaders of these names in shaders/deep_cubemap:

1. list_overlap_jobs: per triangle and face, the rectangle of cells it may touch;
2. overlap: rasterizes the rectangles; the fragment shader tests triangle against cell exactly and
   appends a fragment (cell, triangle, depth interval). A compute shader can do the same, for devices
   that have much arithmetic and few units that rasterize;
3. allocate_bins, count_entries, place_entries, scatter_entries: a counting sort of the fragments
   into lists by cell and depth bin;
4. merge_blocks: a hierarchy of blocks of cells that says which depths are empty.

traverse.glsl walks the result.
"""

import logging
from collections.abc import Mapping

import moderngl
import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from ..scene.errors import DeviceError
from . import records  # noqa: F401  the kernels include Ray and Hit

log = logging.getLogger(__name__)

STATE = Record(
    "DeepCubemapState",
    centre="vec3",
    margin="float",
    core_radius="float",
    scene_radius="float",
    slices_per_metre="float",
    cell_size="float",
    resolution="uint",
    top_level="uint",
    triangle_count="uint",
    job_count="uint",
    job_capacity="uint",
    fragment_count="uint",
    fragment_capacity="uint",
    core_count="uint",
    core_capacity="uint",
    bin_count="uint",
    entry_count="uint",
    job_size="uint",
    greatest_depth_bits="uint",
)
"""Lengths in metres. ``margin``: how far cells are widened; ``cell_size``: 2 / resolution, the size of
a cell on the plane at distance 1; ``job_size``: cells along the longest side of a job;
``greatest_depth_bits``: of the greatest coordinate about the centre, as float bits. The counts may
pass the capacities, then something was dropped and the step is repeated."""

CELL = Record("CubemapCell", near_complement="uint", far="uint", slices="uint", bins="uint")
FRAGMENT = Record("OverlapFragment", cell="uint", triangle="uint", near="float", far="float")
OVERLAP_DRAW = Record("OverlapDraw", first_job="uint", end_job="uint", resolution="uint")
MERGE_LEVEL = Record("MergeLevel", level="uint")
TRACE_RANGE = Record("TraceRange", first_ray="uint", end_ray="uint")

# Of the scene's radius. The margin is some hundred times the rounding error of float positions, so
# that a point that a ray reaches is found in the cells of its triangle; it adds under 1 % of entries.
_MARGIN = 2.0**-17
# Nearer to the centre than this, rays test a list: smaller radii lost hits in experiments.
_CORE_RADIUS = 1 / 500
_DEPTH_SLICES = 32
_CELLS_PER_THREAD = 8
_MOST_BIN_ENDS = 1 << 28
_JOB_SIZE = 16
_ENTRY_SIZE = 8

# Work per submission, so that no driver watchdog mistakes it for a hang.
_RAYS_PER_DISPATCH = 1 << 18
_JOBS_PER_DRAW = 1 << 16
_COMPUTE_JOB_SIZE = 32

_REMEDY = "lower the cubemap resolution or simplify the geometry"


def choose_resolution(triangle_count: int) -> int:
    """Cells along a face's side for a scene of so many triangles: 64, 128 or 256.

    Steps through cells cost more than triangle tests do, so cells get finer only slowly.
    """
    if triangle_count <= 20_000:
        return 64
    return 128 if triangle_count <= 1_000_000 else 256


class DeepCubemap:
    """A deep cubemap on the GPU. Buffers are kept between builds and grow with need.

    ``resolution`` (cells along a face's side), ``centre`` (three floats, metres) and ``counts``
    (jobs, fragments, bin ends, entries, core triangles) are those of the last build.
    ``rasterize``: whether triangles are found in cells by rasterization or in a compute shader.
    """

    def __init__(self, context: Context, library: ProgramLibrary, rasterize: bool = True) -> None:
        self._context = context
        self._rasterize = rasterize
        self._library = library
        self._state = GrowingBuffer(context, "deep cubemap state")
        self._cells = GrowingBuffer(context, "deep cubemap cells", _REMEDY)
        self._jobs = GrowingBuffer(context, "deep cubemap jobs", _REMEDY)
        self._fragments = GrowingBuffer(context, "deep cubemap fragments", _REMEDY)
        self._bins = GrowingBuffer(context, "deep cubemap depth bins", _REMEDY)
        self._entries = GrowingBuffer(context, "deep cubemap entries", _REMEDY)
        self._core = GrowingBuffer(context, "deep cubemap core list", _REMEDY)
        self._buffers = (
            self._state, self._cells, self._jobs, self._fragments, self._bins, self._entries, self._core,
        )  # fmt: skip
        self._framebuffer: moderngl.Framebuffer | None = None
        self._triangles: moderngl.Buffer | None = None
        self.resolution = 0
        self.centre = (0.0, 0.0, 0.0)
        self.counts: dict[str, int] = {}

    def build(
        self,
        triangles: moderngl.Buffer,
        triangle_count: int,
        centre: tuple[float, float, float],
        scene_radius: float,
        resolution: int,
    ) -> None:
        """Sort triangles into the cubemap.

        ``triangles`` holds three vec4 a triangle and must stay as it is while rays are traced.
        ``scene_radius``: the greatest distance from ``centre`` of any vertex (metres); nothing farther
        out is hit. Rays may start anywhere, yet lose precision from some fifty radii on.
        ``resolution``: a power of two from 4 on. Triangles with infinite or NaN coordinates are left out.
        Raises ValueError for other resolutions, and DeviceError where the device's limits are too low.
        """
        if resolution < 4 or resolution & (resolution - 1):
            raise ValueError(f"cubemap resolution {resolution} is not a power of two from 4 on")
        self._triangles = triangles
        self.centre = tuple(float(c) for c in centre)
        self._set_resolution(resolution)
        scene_radius = max(float(scene_radius), 1e-20)
        state = STATE.zeros(1)[0]
        state["centre"] = self.centre
        state["margin"] = scene_radius * _MARGIN
        state["core_radius"] = scene_radius * _CORE_RADIUS
        state["scene_radius"] = scene_radius
        state["cell_size"] = 2 / resolution
        state["resolution"] = resolution
        state["top_level"] = _top_level(resolution)
        state["triangle_count"] = triangle_count
        state["job_size"] = resolution if self._rasterize else _COMPUTE_JOB_SIZE
        self._list_jobs(state)
        self._find_fragments(state)
        self._sort_fragments()
        self._merge_blocks()
        state = self._read_state()
        self.counts = {
            name: int(state[f"{name}_count"]) for name in ("triangle", "job", "fragment", "bin", "entry", "core")
        }
        log.debug("deep cubemap of resolution %d: %s", resolution, self.counts)

    def trace(self, rays: moderngl.Buffer, hits: moderngl.Buffer, count: int) -> None:
        """Find the nearest hit of each of ``count`` Ray records; writes Hit records.

        A hit at just maximum_distance counts, one at distance 0 does not. Where nothing is hit,
        triangle is NO_TRIANGLE and the rest without meaning.
        """
        self._trace("deep_cubemap/trace.comp", {"Rays": rays, "Hits": hits}, count)

    def occluded(self, rays: moderngl.Buffer, visibility: moderngl.Buffer, count: int) -> None:
        """Write a uint for each of ``count`` Ray records: 1 where trace would hit nothing, else 0."""
        self._trace("deep_cubemap/occluded.comp", {"Rays": rays, "Visibility": visibility}, count)

    @property
    def traversal_buffers(self) -> Mapping[str, moderngl.Buffer]:
        """Buffers by block name that kernels which include deep_cubemap/traverse.glsl need."""
        return {
            "Triangles": self._triangles,
            "DeepCubemap": self._state.buffer,
            "CubemapCells": self._cells.buffer,
            "DepthBins": self._bins.buffer,
            "CellEntries": self._entries.buffer,
            "CoreTriangles": self._core.buffer,
        }

    @property
    def memory_bytes(self) -> dict[str, int]:
        """Bytes held, by buffer name."""
        return {buffer.name: buffer.size for buffer in self._buffers}

    def release(self) -> None:
        """Give all GPU memory back."""
        for buffer in self._buffers:
            buffer.release()
        if self._framebuffer is not None:
            self._framebuffer.release()

    def _trace(self, kernel: str, buffers: dict[str, moderngl.Buffer], count: int) -> None:
        program = self._library.compute(kernel)
        buffers = {**self.traversal_buffers, **buffers}
        for first in range(0, count, _RAYS_PER_DISPATCH):
            end = min(first + _RAYS_PER_DISPATCH, count)
            program.run(end - first, buffers, {"first_ray": first, "end_ray": end})

    def _set_resolution(self, resolution: int) -> None:
        if resolution == self.resolution:
            return
        limit = min(
            int(self._context.limits["GL_MAX_TEXTURE_SIZE"]), *map(int, self._context.limits["GL_MAX_VIEWPORT_DIMS"])
        )
        if 3 * resolution > limit:
            raise DeviceError(
                f"a cubemap of resolution {resolution} draws {3 * resolution} pixels wide but the device "
                f"{self._context.information.name} allows {limit}; {_REMEDY}"
            )
        cells = 6 * resolution**2 + _top_level(resolution) * 6 * (resolution // 4) ** 2
        self._cells.require(CELL.size * cells)
        if self._framebuffer is not None:
            self._framebuffer.release()
        self._framebuffer = self._context.moderngl.empty_framebuffer((3 * resolution, 2 * resolution))
        self.resolution = resolution

    def _read_state(self) -> np.void:
        return self._state.read(STATE.dtype, 1)[0].copy()

    def _grow(self, buffer: GrowingBuffer, count: int, size: int) -> int:
        """Make room for ``count`` items of ``size`` bytes, with some to spare; returns the capacity."""
        limit = self._context.storage_block_limit // size
        if count * size > buffer.size:
            buffer.require(max(count, min(count + count // 4, limit)) * size)
        return min(buffer.size // size, limit)

    def _list_jobs(self, state: np.void) -> None:
        """Step 1; fills in what the triangles yield of the state. Repeats when a list was too short."""
        count = int(state["triangle_count"])
        self._grow(self._jobs, min(_expected_jobs(count), self._context.storage_block_limit // _JOB_SIZE), _JOB_SIZE)
        while True:
            state["job_capacity"] = self._jobs.size // _JOB_SIZE
            state["core_capacity"] = self._core.size // 4
            state["job_count"] = state["core_count"] = 0
            self._state.upload(state)
            if count == 0:
                return
            self._library.compute("deep_cubemap/list_overlap_jobs.comp").run(
                count,
                {
                    "Triangles": self._triangles,
                    "DeepCubemap": self._state.buffer,
                    "CoreTriangles": self._core.buffer,
                    "OverlapJobs": self._jobs.buffer,
                },
            )
            found = self._read_state()
            state["job_count"] = found["job_count"]
            state["core_count"] = found["core_count"]
            # The radius would do, but reaches into corners where there are no faces.
            greatest_depth = max(float(found["greatest_depth_bits"].view(np.float32)), 1e-20)
            state["slices_per_metre"] = _DEPTH_SLICES / greatest_depth
            if found["job_count"] <= state["job_capacity"] and found["core_count"] <= state["core_capacity"]:
                return
            self._grow(self._jobs, int(found["job_count"]), _JOB_SIZE)
            self._grow(self._core, int(found["core_count"]), 4)

    def _find_fragments(self, state: np.void) -> None:
        """Step 2; fills the cells, and the fragments. Repeats when their list was too short."""
        expected = _expected_fragments(int(state["triangle_count"]), self.resolution)
        self._grow(self._fragments, min(expected, self._context.storage_block_limit // FRAGMENT.size), FRAGMENT.size)
        buffers = {
            "Triangles": self._triangles,
            "DeepCubemap": self._state.buffer,
            "CubemapCells": self._cells.buffer,
            "OverlapJobs": self._jobs.buffer,
        }
        jobs = int(state["job_count"])
        while True:
            state["fragment_capacity"] = self._fragments.size // FRAGMENT.size
            self._state.upload(state)
            self._cells.clear()
            buffers["OverlapFragments"] = self._fragments.buffer
            for first in range(0, jobs, _JOBS_PER_DRAW):
                self._classify(first, min(first + _JOBS_PER_DRAW, jobs), buffers)
            found = int(self._read_state()["fragment_count"])
            if found <= state["fragment_capacity"]:
                return
            self._grow(self._fragments, found, FRAGMENT.size)

    def _classify(self, first_job: int, end_job: int, buffers: Mapping[str, moderngl.Buffer]) -> None:
        parameters = {"first_job": first_job, "end_job": end_job, "resolution": self.resolution}
        if self._rasterize:
            program = self._library.draw("deep_cubemap/overlap.vert", "deep_cubemap/overlap.frag")
            program.draw(self._framebuffer, 6 * (end_job - first_job), buffers, parameters)
        else:
            self._library.compute("deep_cubemap/overlap.comp").run(end_job - first_job, buffers, parameters)

    def _sort_fragments(self) -> None:
        """Step 3."""
        cell_threads = -(-6 * self.resolution**2 // _CELLS_PER_THREAD)
        state = {"DeepCubemap": self._state.buffer}
        cells = {**state, "CubemapCells": self._cells.buffer}
        self._library.compute("deep_cubemap/allocate_bins.comp").run(
            cell_threads, {**cells, "DepthBins": self._bins.buffer}
        )
        counts = self._read_state()
        if counts["fragment_count"] == 0:
            return
        if counts["bin_count"] > _MOST_BIN_ENDS:
            raise DeviceError(f"deep cubemap depth bins: {counts['bin_count']} of at most {_MOST_BIN_ENDS}; {_REMEDY}")
        self._grow(self._bins, int(counts["bin_count"]), 4)
        self._bins.clear()
        bins = {**cells, "DepthBins": self._bins.buffer}
        fragments = {**bins, "OverlapFragments": self._fragments.buffer}
        fragment_count = int(counts["fragment_count"])
        self._library.compute("deep_cubemap/count_entries.comp").run(fragment_count, fragments)
        self._library.compute("deep_cubemap/place_entries.comp").run(cell_threads, bins)
        self._grow(self._entries, int(self._read_state()["entry_count"]), _ENTRY_SIZE)
        self._library.compute("deep_cubemap/scatter_entries.comp").run(
            fragment_count, {**fragments, "CellEntries": self._entries.buffer}
        )

    def _merge_blocks(self) -> None:
        """Step 4."""
        program = self._library.compute("deep_cubemap/merge_blocks.comp")
        buffers = {"DeepCubemap": self._state.buffer, "CubemapCells": self._cells.buffer}
        for level in range(1, _top_level(self.resolution) + 1):
            program.run(6 * (self.resolution >> (2 * level)) ** 2, buffers, {"level": level})


def _top_level(resolution: int) -> int:
    """Levels of blocks above the cells, each a quarter as fine as the one below."""
    return (resolution.bit_length() - 1) // 2


def _expected_jobs(triangle_count: int) -> int:
    """Most triangles are seen through one face."""
    return 2 * triangle_count + 4096


def _expected_fragments(triangle_count: int, resolution: int) -> int:
    """Walls twice over in every cell, and some cells for each small triangle."""
    return 14 * resolution**2 + 4 * triangle_count
