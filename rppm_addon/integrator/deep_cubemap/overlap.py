# SPDX-License-Identifier: GPL-3.0-or-later
"""Overlap of triangles with the cells of a level: jobs, and the fragments found from them."""

import moderngl

from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from .build_buffers import BuildBuffers
from .clusters import Clusters
from .hierarchy import Level

_PICTURE_SIDE = 4096
"""Pixels of the picture that jobs are drawn into: a tile takes 4 x 4."""
_UNLIMITED_SIDE = 1 << 30


def list_overlap_jobs(buffers: BuildBuffers, triangle_count: int, clusters: Clusters) -> None:
    """List for each triangle, or cluster, or box, the tiles of the base level that it may touch."""
    if clusters.are_boxes:
        buffers.run("list_instance_jobs", triangle_count)
    elif clusters.max_size > 1:
        defines = {**clusters.defines, "MAX_CLUSTER_SIZE": f"{clusters.max_size}u"}
        buffers.run("list_cluster_jobs", -(-triangle_count // clusters.max_size), None, defines)
    else:
        buffers.run("list_overlap_jobs", triangle_count)


class OverlapTest:
    """Tests triangles against cells, by rasterization or in a compute shader, which give the same fragments.

    ``rasterizes`` is None as long as nobody knows which is faster; the compute shader serves until then.
    """

    def __init__(self, context: Context, library: ProgramLibrary, rasterizes: bool | None) -> None:
        self._context, self._library = context, library
        self.rasterizes = rasterizes
        self._framebuffer: moderngl.Framebuffer | None = None

    def find_fragments(self, buffers: BuildBuffers, level: Level, clusters: Clusters) -> None:
        """Append a fragment for each cell of a level that a triangle of the level's jobs touches."""
        side = self._picture_side if self.rasterizes else _UNLIMITED_SIDE
        for first_tile in range(level.first_tile, level.end_tile, (side // 4) ** 2):
            parameters = {
                "job_count": level.job_count,
                "side_exponent": level.side_exponent,
                "first_tile": first_tile,
                "picture_side": side,
            }
            if self.rasterizes:
                self._rasterize(buffers, parameters, clusters)
            else:
                buffers.run("overlap", level.job_count, parameters, clusters.defines)

    def _rasterize(self, buffers: BuildBuffers, parameters: dict[str, int], clusters: Clusters) -> None:
        side = parameters["picture_side"]
        if self._framebuffer is None:
            self._framebuffer = self._context.moderngl.empty_framebuffer((side, side))
        program = self._library.draw("deep_cubemap/overlap.vert", "deep_cubemap/overlap.frag", clusters.defines)
        program.draw(self._framebuffer, 6 * parameters["job_count"], buffers.blocks, parameters)

    @property
    def _picture_side(self) -> int:
        """Side of the picture that jobs are drawn into, pixels."""
        limits = self._context.limits
        return min(_PICTURE_SIDE, int(limits["GL_MAX_TEXTURE_SIZE"]), *map(int, limits["GL_MAX_VIEWPORT_DIMS"]))

    def release(self) -> None:
        """Free the framebuffer."""
        if self._framebuffer is not None:
            self._framebuffer.release()
            self._framebuffer = None
