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

traverse.glsl walks the result. Instances that are not expanded get cubemaps of two levels (levels.py), which
traverse_two_levels.glsl walks.
"""

import logging
from collections.abc import Iterable

import moderngl
import numpy as np

from ...gl.context.context import TEXEL_SIZE, Context
from ...gl.programs.programs import ProgramLibrary
from ...gl.programs.texel_sources import DEFINE as TEXEL_BUFFERS
from ..acceleration.acceleration_structure import AccelerationStructure
from ..acceleration.instances import InstancedMeshes
from ..common.require import require
from .builder import CubemapBuilder
from .clusters import Clusters
from .levels import CubemapLevels
from .parameters import MAX_BINS, MIN_GAIN, cubemap_parameters

log = logging.getLogger(__name__)

FINEST_RESOLUTION = 1 << 14
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
    remedy = CubemapBuilder.remedy

    def __init__(
        self,
        context: Context,
        library: ProgramLibrary,
        rasterize: bool | None = None,
        min_gain: int = MIN_GAIN,
        max_bins: int = MAX_BINS,
        texel_buffers: bool | None = None,
        max_cluster_size: int | None = None,
    ) -> None:
        super().__init__(context, library)
        self._builder = self.own(CubemapBuilder(context, library, rasterize))
        self._levels = self.own(CubemapLevels(context, library))
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
        """AccelerationStructure.build. Cubemaps of instanced meshes that have not changed stay.

        ``resolution``: largest number of cells along a face's side, a power of two from 4 to FINEST_RESOLUTION; 0
        stands for FINEST_RESOLUTION.
        """
        resolution = resolution or FINEST_RESOLUTION
        if not 4 <= resolution <= FINEST_RESOLUTION or resolution & (resolution - 1):
            raise ValueError(f"cubemap resolution {resolution} is not a power of two from 4 to {FINEST_RESOLUTION}")
        buffers = self._builder.buffers
        buffers.triangles, self._has_one_sided, self._instanced = triangles, has_one_sided, instanced
        x, y, z = map(float, center)
        self.center = x, y, z
        parameters = cubemap_parameters(
            np.array(self.center), scene_radius, resolution.bit_length() - 1, triangle_count
        )
        parameters["min_gain"], parameters["max_bins"] = self._min_gain, self._max_bins
        size = self._max_cluster_size
        listed = triangle_count + (instanced.triangle_count if instanced is not None else 0)
        self._clusters = Clusters(size) if size else Clusters.of_scene(listed)
        if instanced is None:
            self._levels.clear()
            state = self._builder.build(parameters, self._clusters)
        else:
            reach = float(scene_radius) + float(np.linalg.norm(self.center))
            state = self._levels.build(self._builder, instanced, parameters, self._clusters, reach)
        self.resolution = 1 << int(state["root_exponent"] + 2 * state["last_level"])
        self.counts = {
            name: int(state[f"{name}_count"])
            for name in ("triangle", "fragment", "tile", "entry", "binned_fragment", "bin", "core")
        }
        log.debug("deep cubemap: %s", self.counts)
        if instanced is None:
            blocks = buffers.blocks
            self._traversal_buffers = {name: blocks[name] for name in _TRAVERSAL_BLOCKS}
        else:
            levels = self._levels.traversal_blocks
            self._traversal_buffers = {"Triangles": triangles, "HitOrigins": instanced.hits.origins, **levels}

    @property
    def traversal_defines(self) -> dict[str, object]:
        """AccelerationStructure.traversal_defines."""
        buffers = self._builder.buffers
        arrays = buffers if self._instanced is None else self._levels.arrays
        read = arrays.cells.size, arrays.entries.size, require(buffers.triangles).size
        fits = max(read) <= TEXEL_SIZE * self._context.max_texels
        is_asked_for = self._texel_buffers or max(read[:2]) > self._context.storage_block_limit
        texel_buffers: dict[str, object] = {TEXEL_BUFFERS: 1} if fits and is_asked_for else {}
        levels = {"TRAVERSAL": "deep_cubemap/traverse_two_levels.glsl"} if self._instanced is not None else {}
        return {**super().traversal_defines, **texel_buffers, **self._clusters.defines, **levels}

    @property
    def lean_traversal_defines(self) -> dict[str, object]:
        """AccelerationStructure.lean_traversal_defines: two levels take two blocks more than one, and cells and entries
        are texels in their place."""
        return {**self.traversal_defines, **({TEXEL_BUFFERS: 1} if self.has_instances else {})}

    @property
    def route(self) -> str | None:
        """Way in which triangles are found in cells; None where that has not been decided yet."""
        return self._builder.route
