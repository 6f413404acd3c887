# SPDX-License-Identifier: GPL-3.0-or-later
"""The deep cubemap (DIRT): builds it by rasterization, traces rays through it.

All triangles are sorted into the cells of a cubemap around a center and, within a cell, by depth.
Cells that hold many triangles are divided into tiles of 4 x 4 cells, level by level, so that a small
detailed object in a large scene gets small cells and a bare wall large ones.
Building takes these steps, shaders of these names in shaders/deep_cubemap:

1. initialize_base: divides the faces down to the base level; list_overlap_jobs: lists for each triangle the tiles of
   the base level that it may touch; list_cluster_jobs: the same in scenes of many triangles, where triangles that
   follow each other and lie together are listed as one cluster (clusters.py);
2. overlap: rasterizes the jobs; the fragment shader tests triangle against cell exactly and appends a
   fragment (cell, triangle, depth interval). A compute shader can do the same, for devices that have
   much arithmetic and few units that rasterize (overlap.py);
3. divide: decides which cells get a tile and which a list of entries; propagate: passes the fragments on
   to either (hierarchy.py). Those of tiles are rasterized again (2), until nothing is divided any more;
4. allocate_bins, count_entries, place_entries, scatter_entries: a counting sort into depth bins for cells that hold
   much and cannot be divided with gain (depth_bins.py);
5. merge_tiles: merges the contents of tiles into the cells above the base level.

traverse.glsl walks the result.
"""

import logging
from collections.abc import Iterable

import moderngl
import numpy as np

from ...gl.buffer_sets import Part
from ...gl.context.context import TEXEL_SIZE, Context
from ...gl.programs.programs import ProgramLibrary
from ...gl.programs.texel_sources import DEFINE as TEXEL_BUFFERS
from ..acceleration.acceleration_structure import MARGIN, AccelerationStructure
from ..acceleration.instances import InstancedMeshes
from ..common.require import require
from .build_buffers import BuildBuffers, LevelTooFineError, ListTooShortError
from .clusters import Clusters
from .depth_bins import sort_into_bins
from .hierarchy import Hierarchy
from .level_limit import LevelLimit
from .overlap import OverlapTest, list_overlap_jobs
from .records import STATE

log = logging.getLogger(__name__)

FINEST_RESOLUTION = 1 << 14

_CORE_MARGINS = 64.0
"""Radius of the core, in margins: nearer to the center, rays test a list."""
_BASE_LEVEL = 2
_MIN_GAIN = 32
_MAX_BINS = 64
_MIN_TRIAL_TRIANGLES, _MAX_TRIAL_TRIANGLES = 1000, 16384
"""Triangles to try both routes with."""
_TRAVERSAL_BLOCKS = "Triangles", "DeepCubemap", "CubemapCells", "DepthBins", "CellEntries", "CoreTriangles"


class DeepCubemap(AccelerationStructure):
    """A deep cubemap on the GPU. Buffers are kept between builds and grow with need.

    ``resolution`` (cells along a face's side where they are finest), ``center`` (three floats, meters)
    and ``counts`` are those of the last build; ``fragment`` counts those of all levels.
    ``rasterize``: whether triangles are found in cells by rasterization or in a compute shader, which leave the
    same behind; None takes the one that is faster, found by trying both with the first scene of a thousand triangles.
    ``min_gain``: cells are divided where that leaves at least so many fewer triangles in each.
    ``max_bins``: largest number of depth bins of a cell.
    ``max_cluster_size``: largest number of triangles, 1, 2, 4 or 8, that an entry of a cell names, which changes no
    hit; None leaves it to the number of triangles of the scene.
    ``texel_buffers``: whether rays read cells, entries and triangles as texels, which changes no hit; None leaves it
    to the kind of driver. What is too long for that is read from storage blocks.
    """

    shader = "deep_cubemap/traverse.glsl"
    remedy = BuildBuffers.remedy
    _buffers = Part(BuildBuffers)

    def __init__(
        self,
        context: Context,
        library: ProgramLibrary,
        rasterize: bool | None = None,
        min_gain: int = _MIN_GAIN,
        max_bins: int = _MAX_BINS,
        texel_buffers: bool | None = None,
        max_cluster_size: int | None = None,
    ) -> None:
        super().__init__(context, library)
        self._overlap = self.own(OverlapTest(context, library, rasterize))
        self._level_limit = LevelLimit()
        self._max_cluster_size, self._clusters = max_cluster_size, Clusters()
        self._min_gain, self._max_bins = min_gain, max_bins
        self._texel_buffers = context.is_software if texel_buffers is None else texel_buffers
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
        instanced: InstancedMeshes | None = None,
    ) -> None:
        """AccelerationStructure.build, of one level: ValueError is raised where instances are given.

        ``resolution``: largest number of cells along a face's side, a power of two from 4 to FINEST_RESOLUTION; 0
        stands for FINEST_RESOLUTION.
        """
        if instanced is not None:
            raise ValueError("a deep cubemap has one level; expand the instances")
        resolution = resolution or FINEST_RESOLUTION
        if not 4 <= resolution <= FINEST_RESOLUTION or resolution & (resolution - 1):
            raise ValueError(f"cubemap resolution {resolution} is not a power of two from 4 to {FINEST_RESOLUTION}")
        self._buffers.triangles, self._has_one_sided = triangles, has_one_sided
        x, y, z = map(float, center)
        self.center = x, y, z
        parameters = self._parameters(triangle_count, scene_radius, resolution.bit_length() - 1)
        size = self._max_cluster_size
        self._clusters = Clusters(size) if size else Clusters.of_scene(triangle_count)
        self._buffers.reserve(triangle_count, self._clusters)
        if self._overlap.rasterizes is None and triangle_count >= _MIN_TRIAL_TRIANGLES:
            self._overlap.rasterizes = self._is_faster_rasterized(parameters)
        fragment_count = self._build(parameters)
        state = self._buffers.read_state()
        state["fragment_count"] = fragment_count
        self.counts = {
            name: int(state[f"{name}_count"])
            for name in ("triangle", "fragment", "tile", "entry", "binned_fragment", "bin", "core")
        }
        log.debug("deep cubemap: %s", self.counts)
        blocks = self._buffers.blocks
        self._traversal_buffers = {name: blocks[name] for name in _TRAVERSAL_BLOCKS}

    def _parameters(self, triangle_count: int, scene_radius: float, exponent: int) -> np.void:
        """Return the STATE that a build begins with. exponent: log2 of the cells along a face's side."""
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
        state["min_gain"] = self._min_gain
        state["max_bins"] = self._max_bins
        state["triangle_count"] = triangle_count
        return state

    def _build(self, parameters: np.void) -> int:
        """Build until all lists are long enough, with coarser cells where the device cannot hold them.

        Returns the number of fragments of all levels.
        """
        parameters = parameters.copy()
        self._level_limit.apply(parameters)
        while True:
            try:
                return self._sort_triangles(parameters)
            except ListTooShortError:
                continue
            except LevelTooFineError as error:
                self._level_limit.lower(parameters, error)

    def _sort_triangles(self, parameters: np.void) -> int:
        """Sort the triangles into cells and bins; returns the number of fragments of all levels."""
        buffers = self._buffers
        hierarchy = Hierarchy(buffers, parameters)
        hierarchy.initialize_base(parameters)
        list_overlap_jobs(buffers, int(parameters["triangle_count"]), self._clusters)
        level = hierarchy.base_level()
        self._overlap.find_fragments(buffers, level, self._clusters)
        while (finer_level := hierarchy.divide(level)) is not None:
            level = finer_level
            self._overlap.find_fragments(buffers, level, self._clusters)
        sort_into_bins(buffers, level)
        hierarchy.merge(level)
        self.resolution = level.resolution
        return hierarchy.fragment_count

    def _is_faster_rasterized(self, parameters: np.void) -> bool:
        """Build with the first triangles by both routes, twice as the first time compiles, and compare the clock."""
        trial = parameters.copy()
        trial["triangle_count"] = min(int(trial["triangle_count"]), _MAX_TRIAL_TRIANGLES)
        seconds = {}
        for rasterizes in (False, True, False, True):
            self._overlap.rasterizes = rasterizes
            seconds[rasterizes] = self._context.seconds_of(lambda: self._build(trial))
        log.debug("deep cubemap: %.1f ms by compute shader, %.1f ms rasterized", *(1e3 * s for s in seconds.values()))
        return seconds[True] < seconds[False]

    @property
    def traversal_defines(self) -> dict[str, object]:
        """AccelerationStructure.traversal_defines."""
        read = self._buffers.cells.size, self._buffers.entries.size, require(self._buffers.triangles).size
        fits = max(read) <= TEXEL_SIZE * self._context.max_texels
        is_asked_for = self._texel_buffers or self._buffers.entries.size > self._context.storage_block_limit
        texel_buffers: dict[str, object] = {TEXEL_BUFFERS: 1} if fits and is_asked_for else {}
        return {**super().traversal_defines, **texel_buffers, **self._clusters.defines}

    @property
    def route(self) -> str | None:
        """Way in which triangles are found in cells; None where that has not been decided yet."""
        return {True: "rasterization", False: "compute shader", None: None}[self._overlap.rasterizes]
