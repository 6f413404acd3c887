# SPDX-License-Identifier: GPL-3.0-or-later
"""The deep cubemap (DIRT): builds it by rasterization, traces rays through it.

All triangles are sorted into the cells of a cubemap around a center and, within a cell, by depth.
Cells that hold many triangles are divided into tiles of 4 x 4 cells, level by level, so that a small
detailed object in a large scene gets small cells and a bare wall large ones.
Building takes these steps, shaders of these names in shaders/deep_cubemap:

1. initialize_base: divides the faces down to the base level; list_overlap_jobs: per triangle, the tiles of the
   base level that it may touch; list_cluster_jobs: the same in scenes of many triangles, where those that follow each
   other and lie together stand in lists as one (clusters.glsl);
2. overlap: rasterizes the jobs; the fragment shader tests triangle against cell exactly and appends a
   fragment (cell, triangle, depth interval). A compute shader can do the same, for devices that have
   much arithmetic and few units that rasterize;
3. divide: decides which cells get a tile and which a list of entries; propagate: hands the fragments
   on to either. What went to tiles is rasterized again (2), until nothing is divided any more;
4. allocate_bins, count_entries, place_entries, scatter_entries: a counting sort into depth bins for cells that hold
   much and cannot be divided with gain;
5. merge_tiles: what the cells above the base level hold.

traverse.glsl walks the result.
"""

import enum
import logging
from collections.abc import Iterable, Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import TEXEL_SIZE, Context
from ...gl.programs.programs import ProgramLibrary
from ...gl.programs.texel_sources import DEFINE as TEXEL_BUFFERS
from ...scene.errors import DeviceError, DeviceLostError
from ..acceleration.acceleration_structure import MARGIN, AccelerationStructure
from ..common.require import require

log = logging.getLogger(__name__)

STATE = Record(
    "DeepCubemapState",
    center="vec3",
    margin="float",
    low_complement="uvec3",
    root_exponent="uint",
    high="uvec3",
    root_count="uint",
    core_radius="float",
    scene_radius="float",
    base_level="uint",
    last_level="uint",
    least_gain="uint",
    most_bins="uint",
    triangle_count="uint",
    bin_count="uint",
    handed_binned_count="uint",
    tile_count="uint",
    tile_capacity="uint",
    job_count="uint",
    job_capacity="uint",
    fragment_count="uint",
    fragment_capacity="uint",
    fragment_limit="uint",
    reserved_count="uint",
    entry_count="uint",
    entry_capacity="uint",
    binned_cell_count="uint",
    binned_cell_capacity="uint",
    binned_fragment_count="uint",
    binned_fragment_capacity="uint",
    core_count="uint",
    core_capacity="uint",
)
"""Lengths in meters. ``margin``: how far cells are widened; ``root_exponent``: log2 of the roots along
a face's side. The counts may pass the capacities, then something was dropped and building starts over."""

CELL = Record("CubemapCell", near_complement="uint", far="uint", slices="uint", content="uint")
FRAGMENT = Record(
    "OverlapFragment",
    cell="uint",
    triangle="uint",
    near="uint",
    far="uint",
    extent_low="uint",
    extent_high="uint",
)
BINNED_FRAGMENT = Record("BinnedFragment", cell="uint", triangle="uint", depths="uint")


class CellKind(enum.IntEnum):
    """Kinds of cells that are not empty, by what they hold."""

    LIST = 0
    """A few triangles."""
    BINS = 1
    """Many, by depth."""
    TILE = 2
    """Smaller cells."""


JOIN_MOST = 5
"""Log2 of the slices of depth that one bin may hold: all 32 of a cell."""
Constants("CellKinds", CELL=CellKind)
Constants("DepthBins", signed=True, JOIN_MOST=JOIN_MOST)
StorageBlock("BinnedFragments", "BinnedFragment binned_fragments[];")
StorageBlock("OverlapJobs", "uvec4 overlap_jobs[];")
StorageBlock("CellEntries", "uvec2 cell_entries[];")
BINNED_CELL = Record("BinnedCell", cell="uint", fragments="uint", slices="uint")
Record("OverlapDraw", job_count="uint", side_exponent="uint", first_tile="uint", picture_side="uint")
CELLS_OF_A_TILE = 16
"""Told to shaders as a number that drivers do not know: loops of so few rounds are written out and compile for long."""
Record(
    "DivideLevel",
    first_tile="uint",
    end_tile="uint",
    level="uint",
    side_exponent="uint",
    fragment_count="uint",
    tile_cells="uint",
)
Record("MergeLevel", first_cell="uint", end_cell="uint", tile_cells="uint")

FINEST_RESOLUTION = 1 << 14

# Nearer to the center than this many margins, rays test a list.
_CORE_MARGINS = 64.0
_BASE_LEVEL = 2
_LEAST_GAIN = 32
_MOST_BINS = 64
_MOST_ROOTS = 24
_PICTURE_SIDE = 4096
"""Pixels of the picture that jobs are drawn into: a tile takes 4 x 4."""

# Triangles to try both routes with.
_TRIAL_LEAST, _TRIAL_MOST = 1000, 16384

_CLUSTERED = {1 << 24: 8, 1 << 20: 4}
"""In scenes of at least so many triangles, how many a cluster has at most: docs/benchmarks/instances.md."""
_LISTED_BY_CLUSTERS = {1: 1.0, 2: 0.7, 4: 0.5, 8: 0.3}
"""Lengths of lists over those without clusters, by that."""
_SURELY = 0.8
"""Fraction of its expected length that a long list has at least."""
_MOST_STARTS = 1 << 26
"""Places of entries and bins that cells can name (shaders/deep_cubemap/cells.glsl)."""
_READ_AS_TEXELS = "CubemapCells", "CellEntries", "Triangles"


class _TooShort(Exception):
    """A list did not hold everything; it has been grown."""


class _TooLong(Exception):
    """A list that the cells of ``level`` needed is longer than the device allows; ``cause`` says which."""

    def __init__(self, level: int, cause: DeviceError) -> None:
        self.level, self.cause = level, cause


class DeepCubemap(AccelerationStructure):
    """A deep cubemap on the GPU. Buffers are kept between builds and grow with need.

    ``resolution`` (cells along a face's side where they are finest), ``center`` (three floats, meters)
    and ``counts`` are those of the last build; ``fragment`` counts those of all levels.
    ``rasterize``: whether triangles are found in cells by rasterization or in a compute shader, which leave the
    same behind; None takes the one that is faster, found by trying both with the first scene of a thousand triangles.
    ``least_gain``: cells are divided where that leaves so many fewer triangles in each.
    ``most_bins``: depth bins that a cell may have at most.
    ``most_clustered``: triangles, 1, 2, 4 or 8, that entries of cells may stand for together, which changes no hit;
    None leaves it to how many the scene has.
    ``texel_buffers``: whether rays read cells, entries and triangles as texels, which changes no hit; None leaves it
    to the kind of driver. What is too long for that is read from storage blocks.
    """

    shader = "deep_cubemap/traverse.glsl"
    remedy = "lower the cubemap resolution or simplify the geometry"
    _state = StorageBuffer("deep cubemap state", STATE)
    _cells = StorageBuffer("deep cubemap cells", CELL)
    _bins = StorageBuffer("deep cubemap depth bins", "uint")
    _tiles = StorageBuffer("deep cubemap tiles", "uint")
    _jobs = StorageBuffer("deep cubemap jobs", "uvec4", texel_bytes=16)
    _fragments = StorageBuffer("deep cubemap fragments", FRAGMENT, texel_bytes=8)
    _fragments_above = StorageBuffer("deep cubemap fragments of the level above", FRAGMENT, texel_bytes=8)
    _entries = StorageBuffer("deep cubemap entries", "uvec2", texel_bytes=8)
    _binned_cells = StorageBuffer("deep cubemap binned cells", BINNED_CELL)
    _binned_fragments = StorageBuffer("deep cubemap binned fragments", BINNED_FRAGMENT, texel_bytes=4)
    _core = StorageBuffer("deep cubemap core list", "uint", 16)

    def __init__(
        self,
        context: Context,
        library: ProgramLibrary,
        rasterize: bool | None = None,
        least_gain: int = _LEAST_GAIN,
        most_bins: int = _MOST_BINS,
        texel_buffers: bool | None = None,
        most_clustered: int | None = None,
    ) -> None:
        super().__init__(context, library)
        self._rasterize = rasterize
        self._wanted_clusters, self._most_clustered = most_clustered, 1
        self._least_gain, self._most_bins = least_gain, most_bins
        self._texel_buffers = context.is_software if texel_buffers is None else texel_buffers
        self._most_texel_bytes = TEXEL_SIZE * context.most_texels

        self._lists = {
            "job": self._jobs,
            "fragment": self._fragments,
            "entry": self._entries,
            "binned_cell": self._binned_cells,
            "binned_fragment": self._binned_fragments,
            "core": self._core,
        }
        """By name of their count and capacity in the state."""
        self._old_fragments = self._fragments_above
        """Changes places with the list of fragments, level by level."""
        self._framebuffer: moderngl.Framebuffer | None = None
        self._too_many, self._last_level = 1 << 32, 0
        self._fragments_found = 0
        self.resolution = 0
        self.center = (0.0, 0.0, 0.0)
        self.counts: dict[str, int] = {}

    def build(
        self,
        triangles: moderngl.Buffer,
        triangle_count: int,
        center: Iterable[float],
        scene_radius: float,
        resolution: int = 0,
        has_one_sided: bool = False,
    ) -> None:
        """AccelerationStructure.build.

        ``resolution``: the most cells along a face's side, a power of two from 4 to FINEST_RESOLUTION, which 0 stands
        for too.
        """
        resolution = resolution or FINEST_RESOLUTION
        if not 4 <= resolution <= FINEST_RESOLUTION or resolution & (resolution - 1):
            raise ValueError(f"cubemap resolution {resolution} is not a power of two from 4 to {FINEST_RESOLUTION}")
        self._triangles, self._has_one_sided = triangles, has_one_sided
        x, y, z = map(float, center)
        self.center = x, y, z
        exponent = resolution.bit_length() - 1
        scene_radius = max(float(scene_radius), 1e-20)
        state = STATE.zeros(1)[0]
        state["center"] = self.center
        state["margin"] = scene_radius * MARGIN
        state["core_radius"] = scene_radius * MARGIN * _CORE_MARGINS
        state["scene_radius"] = scene_radius
        state["root_exponent"] = exponent % 2
        state["root_count"] = 6 << (2 * state["root_exponent"])
        state["last_level"] = exponent // 2
        state["base_level"] = min(_BASE_LEVEL, exponent // 2)
        state["least_gain"] = self._least_gain
        state["most_bins"] = self._most_bins
        state["triangle_count"] = triangle_count
        self._most_clustered = self._wanted_clusters or _most_clustered(triangle_count)
        self._expect(triangle_count)
        if self._rasterize is None and triangle_count >= _TRIAL_LEAST:
            self._rasterize = self._is_faster_rasterized(state)
        self._build(state)
        state = self._read_state()
        state["fragment_count"] = self._fragments_found
        self.counts = {
            name: int(state[f"{name}_count"])
            for name in ("triangle", "fragment", "tile", "entry", "binned_fragment", "bin", "core")
        }
        log.debug("deep cubemap: %s", self.counts)

    @property
    def traversal_buffers(self) -> Mapping[str, moderngl.Buffer]:
        """AccelerationStructure.traversal_buffers."""
        return {
            "Triangles": require(self._triangles),
            "DeepCubemap": self._state.buffer,
            "CubemapCells": self._cells.buffer,
            "DepthBins": self._bins.buffer,
            "CellEntries": self._entries.buffer,
            "CoreTriangles": self._core.buffer,
        }

    @property
    def traversal_defines(self) -> dict[str, object]:
        """AccelerationStructure.traversal_defines."""
        fits = all(self.traversal_buffers[name].size <= self._most_texel_bytes for name in _READ_AS_TEXELS)
        is_asked_for = self._texel_buffers or self._entries.size > self._context.storage_block_limit
        texel_buffers: dict[str, object] = {TEXEL_BUFFERS: 1} if fits and is_asked_for else {}
        return {**super().traversal_defines, **texel_buffers, **self._cluster_defines}

    @property
    def _cluster_defines(self) -> dict[str, object]:
        """Defines of programs that know what entries of cells stand for."""
        return {"TRIANGLE_CLUSTERS": 1} if self._most_clustered > 1 else {}

    @property
    def route(self) -> str | None:
        """How triangles are found in cells; None where that has not been decided yet (a compute shader serves)."""
        return {True: "rasterization", False: "compute shader", None: None}[self._rasterize]

    def _read_state(self) -> np.void:
        return self._state.read(STATE.dtype, 1)[0].copy()

    def _is_faster_rasterized(self, state: np.void) -> bool:
        """Build with the first triangles by both routes, twice as the first time compiles, and compare the clock."""
        trial = state.copy()
        trial["triangle_count"] = min(int(trial["triangle_count"]), _TRIAL_MOST)
        seconds = {}
        for self._rasterize in (False, True, False, True):
            seconds[self._rasterize] = self._context.seconds_of(lambda: self._build(trial))
        log.debug("deep cubemap: %.1f ms by compute shader, %.1f ms rasterized", *(1e3 * s for s in seconds.values()))
        return seconds[True] < seconds[False]

    def _expect(self, triangle_count: int) -> None:
        """Room for an ordinary scene of so many triangles, as far as the device allows it. Lists are longer than a
        block only where they surely must be, which saves building in vain until they are."""
        limit = self._context.storage_block_limit
        for name, expected in _expected(triangle_count, _LISTED_BY_CLUSTERS[self._most_clustered]).items():
            size = 16 * CELL.size if name == "tile" else self._lists[name].item_size
            most = limit // size - 2
            if name != "tile" and _SURELY * expected > most:
                try:
                    self._grow(name, min(expected, self._lists[name].limit // size - 2))
                except DeviceLostError:
                    raise
                except DeviceError as error:
                    log.debug("%s", error)  # coarser cells may do with fewer
            self._grow(name, min(expected, most))

    def _grow(self, name: str, count: int) -> None:
        """Make room for ``count`` items of a list, with some to spare where the device allows it."""
        limit = self._context.storage_block_limit
        if name != "tile" and count * self._lists[name].item_size > limit:
            limit = self._lists[name].limit

        def room(number: int, spacious: int) -> int:
            return -(-max(number, min(spacious, limit)) // TEXEL_SIZE) * TEXEL_SIZE

        spacious = count + count // 4
        if name == "tile":
            self._tiles.require(room(4 * count, 4 * spacious))
            self._cells.require(room(CELL.size * (_MOST_ROOTS + 16 * count), CELL.size * (_MOST_ROOTS + 16 * spacious)))
            return
        buffer = self._lists[name]
        if count > buffer.capacity:
            buffer.require(room(count * buffer.item_size, spacious * buffer.item_size))
        if name == "fragment":
            self._old_fragments.require(buffer.size)

    def _set_capacities(self, state: np.void) -> None:
        state["tile_capacity"] = min((self._cells.capacity - _MOST_ROOTS) // 16, self._tiles.capacity)
        for name, buffer in self._lists.items():
            state[f"{name}_capacity"] = buffer.capacity
        state["fragment_limit"] = self._fragments.limit // FRAGMENT.size
        state["fragment_capacity"] = min(int(state["fragment_capacity"]), self._old_fragments.capacity)

    def _check_lists(self, state: np.void, level: int) -> None:
        """Raise _TooShort when lists were, which cells of a level needed, after making room.

        Raises _TooLong where the device does not allow that.
        """
        names = [name for name in ("tile", *self._lists) if state[f"{name}_count"] > state[f"{name}_capacity"]]
        for name in names:
            log.debug("deep cubemap: %d of %d %s", state[f"{name}_count"], state[f"{name}_capacity"], name)
            try:
                self._grow(name, int(state[f"{name}_count"]))
            except DeviceError as error:
                raise _TooLong(level, error) from error
        if names:
            raise _TooShort

    def _check_starts(self, name: str, count: int, level: int) -> None:
        """Raise _TooLong where cells of a level have more of what they name the place of than they can."""
        if count > _MOST_STARTS:
            raise _TooLong(level, DeviceError(f"{count} {name} of cells are more than {_MOST_STARTS}; {self.remedy}"))

    def _build(self, state: np.void) -> None:
        """Try until all lists are long enough, with coarser cells where the device cannot hold them."""
        state = state.copy()
        if state["triangle_count"] >= self._too_many:
            state["last_level"] = min(state["last_level"], self._last_level)
        while True:
            try:
                return self._try(state)
            except _TooShort:
                continue
            except _TooLong as too_long:
                if state["last_level"] > state["base_level"]:
                    state["last_level"] = min(too_long.level, int(state["last_level"])) - 1
                elif state["base_level"] > 1:
                    state["base_level"] = state["last_level"] = 1
                else:
                    raise too_long.cause from None
                # builds to come of as many triangles start with that
                self._too_many, self._last_level = int(state["triangle_count"]), int(state["last_level"])
                log.warning(
                    "%s; for now cells stay at a resolution of %d, which slows rays down",
                    too_long.cause,
                    1 << int(state["root_exponent"] + 2 * state["last_level"]),
                )

    def _try(self, parameters: np.void) -> None:
        state = parameters.copy()
        self._set_capacities(state)
        root_exponent, base = int(state["root_exponent"]), int(state["base_level"])
        level_tiles = [int(state["root_count"]) * 16**level for level in range(base)]
        state["tile_count"] = sum(level_tiles)
        self._state.upload(state)
        buffers = {
            "DeepCubemap": self._state.buffer,
            "CubemapCells": self._cells.buffer,
            "CubemapTiles": self._tiles.buffer,
            "OverlapJobs": self._jobs.buffer,
            "NewFragments": self._lists["fragment"].buffer,
            "OldFragments": self._old_fragments.buffer,
            "BinnedFragments": self._binned_fragments.buffer,
            "BinnedCells": self._binned_cells.buffer,
            "CellEntries": self._entries.buffer,
            "CoreTriangles": self._core.buffer,
            "Triangles": require(self._triangles),
        }

        def run(
            name: str, threads: int, parameters: dict | None = None, defines: Mapping[str, object] | None = None
        ) -> None:
            program = self._library.compute(f"deep_cubemap/{name}.comp", defines)
            program.run(threads, {block: buffers[block] for block in program.blocks}, parameters)

        run("initialize_base", int(state["tile_count"]))
        if self._most_clustered > 1:
            defines = {**self._cluster_defines, "MOST_CLUSTERED": f"{self._most_clustered}u"}
            run("list_cluster_jobs", -(-int(state["triangle_count"]) // self._most_clustered), None, defines)
        else:
            run("list_overlap_jobs", int(state["triangle_count"]))
        first_tile, level = sum(level_tiles[:-1]), base
        self._fragments_found = 0
        while True:
            state = self._read_state()
            self._check_lists(state, level)
            side_exponent = root_exponent + 2 * level
            end_tile = int(state["tile_count"])
            self._classify(buffers, int(state["job_count"]), first_tile, end_tile, side_exponent)
            state = self._read_state()
            self._check_lists(state, level)
            fragments = int(state["fragment_count"])
            self._fragments_found += fragments
            self._old_fragments, self._lists["fragment"] = self._lists["fragment"], self._old_fragments
            buffers["NewFragments"] = self._lists["fragment"].buffer
            buffers["OldFragments"] = self._old_fragments.buffer
            state["job_count"] = state["fragment_count"] = state["reserved_count"] = 0
            self._state.upload(state)
            division = {
                "first_tile": first_tile, "end_tile": end_tile, "level": level, "side_exponent": side_exponent,
                "fragment_count": fragments, "tile_cells": CELLS_OF_A_TILE,
            }  # fmt: skip
            run("divide", end_tile - first_tile, division)
            run("propagate", fragments, division)
            state = self._read_state()
            self._check_lists(state, level + 1)
            self._check_starts("entries", int(state["entry_count"]), level + 1)
            if int(state["tile_count"]) == end_tile:
                break
            first_tile, level = end_tile, level + 1
        self.resolution = 1 << side_exponent
        if state["binned_fragment_count"]:
            buffers["DepthBins"] = self._bins.buffer
            run("allocate_bins", int(state["binned_cell_count"]))
            bins = int(self._read_state()["bin_count"])
            self._check_starts("depth bins", bins, level)
            try:
                self._bins.require_items(bins)
            except DeviceError as error:
                raise _TooLong(level, error) from error
            self._bins.clear()
            buffers["DepthBins"] = self._bins.buffer
            run("count_entries", int(state["binned_fragment_count"]))
            run("place_entries", int(state["binned_cell_count"]))
            self._check_lists(self._read_state(), level)
            run("scatter_entries", int(state["binned_fragment_count"]))
        for upper in range(base - 1, -1, -1):
            first = sum(level_tiles[:upper])
            end = first + level_tiles[upper]
            cells = {"first_cell": first, "end_cell": end, "tile_cells": CELLS_OF_A_TILE}
            run("merge_tiles", level_tiles[upper], cells)
        state = self._read_state()
        state["last_level"] = level
        self._state.upload(state)

    def _classify(
        self, buffers: Mapping[str, moderngl.Buffer], jobs: int, first_tile: int, end_tile: int, side_exponent: int
    ) -> None:
        side = self._picture_side() if self._rasterize else 1 << 30
        for picture_tile in range(first_tile, end_tile, (side // 4) ** 2):
            parameters = {
                "job_count": jobs, "side_exponent": side_exponent, "first_tile": picture_tile, "picture_side": side,
            }  # fmt: skip
            self._overlap(jobs, buffers, parameters)

    def _overlap(self, jobs: int, buffers: Mapping[str, moderngl.Buffer], parameters: dict[str, int]) -> None:
        if not self._rasterize:
            computed = self._library.compute("deep_cubemap/overlap.comp", self._cluster_defines)
            computed.run(jobs, {block: buffers[block] for block in computed.blocks}, parameters)
            return
        side = parameters["picture_side"]
        if self._framebuffer is None:
            self._framebuffer = self.own(self._context.moderngl.empty_framebuffer((side, side)))
        drawn = self._library.draw("deep_cubemap/overlap.vert", "deep_cubemap/overlap.frag", self._cluster_defines)
        drawn.draw(self._framebuffer, 6 * jobs, {block: buffers[block] for block in drawn.blocks}, parameters)

    def _picture_side(self) -> int:
        """Return the side of the picture that jobs are drawn into, pixels."""
        limits = self._context.limits
        return min(_PICTURE_SIDE, int(limits["GL_MAX_TEXTURE_SIZE"]), *map(int, limits["GL_MAX_VIEWPORT_DIMS"]))


def _most_clustered(triangle_count: int) -> int:
    """Triangles of a scene that entries stand for together at most."""
    return next((most for least, most in _CLUSTERED.items() if triangle_count >= least), 1)


def _expected(triangle_count: int, share: float) -> dict[str, int]:
    """Lengths of lists that ordinary scenes of so many triangles do not pass. share: of those without clusters."""
    number = int(share * triangle_count)
    return {
        "job": 5 * number // 2 + 4096,
        "fragment": 4 * number + 16384,
        "tile": number // 32 + 4096,
        "entry": 7 * number + 16384,
        "binned_cell": number // 4 + 4096,
        "binned_fragment": 5 * number + 16384,
    }
