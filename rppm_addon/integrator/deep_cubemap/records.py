# SPDX-License-Identifier: GPL-3.0-or-later
"""Records, constants and storage blocks of the deep cubemap."""

import enum

from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock

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
    min_gain="uint",
    max_bins="uint",
    triangle_count="uint",
    first_triangle="uint",
    box_triangles="uint",
    first_cell="uint",
    first_entry="uint",
    first_bin="uint",
    first_core="uint",
    bin_count="uint",
    propagated_binned_count="uint",
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
a face's side; ``first_triangle``: in the block Triangles, from which on triangles are counted; ``box_triangles``: of a
box; ``first_cell``, ``first_entry``, ``first_bin``, ``first_core``: where its parts begin in blocks that several
cubemaps share. The counts may pass the capacities, then something was dropped and building starts over."""

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
BINNED_CELL = Record("BinnedCell", cell="uint", fragments="uint", slices="uint")
Record("OverlapDraw", job_count="uint", side_exponent="uint", first_tile="uint", picture_side="uint")
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


class CellKind(enum.IntEnum):
    """Kinds of cells that are not empty, by what they hold."""

    LIST = 0
    """A few triangles."""
    BINS = 1
    """Many, by depth."""
    TILE = 2
    """Smaller cells."""


MAX_JOIN = 5
"""Log2 of the slices of depth that one bin may hold: all 32 of a cell."""
TILE_CELLS = 16
"""Cells of a tile. Shaders get it as a parameter: drivers unroll loops of so few rounds if they know the number, and
compile for long."""
Constants("CellKinds", CELL=CellKind)
Constants("DepthBins", signed=True, MAX_JOIN=MAX_JOIN)
StorageBlock("BinnedFragments", "BinnedFragment binned_fragments[];")
StorageBlock("OverlapJobs", "uvec4 overlap_jobs[];")
StorageBlock("CellEntries", "uvec2 cell_entries[];")
StorageBlock("InstanceBoxes", "vec4 instance_boxes[];")
"""The low and the high corner of each."""
StorageBlock("DeepCubemaps", "DeepCubemapState deep_cubemaps[];")
"""Cubemaps of two levels: those of world triangles and of instances, then those of meshes."""
WORLD_LEVEL, INSTANCE_LEVEL, FIRST_MESH = range(3)
Constants("CubemapLevels", WORLD_LEVEL=WORLD_LEVEL, INSTANCE_LEVEL=INSTANCE_LEVEL)
BOX_TRIANGLES = 12
"""Triangles of a box. Shaders get it in the state, for the same reason as TILE_CELLS."""
