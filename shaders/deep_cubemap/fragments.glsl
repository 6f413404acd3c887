// SPDX-License-Identifier: GPL-3.0-or-later
// What rasterization leaves behind: a triangle in a cell with its depth interval (codes), in no order.
// Those of one level make those of the next.
#include <OverlapFragment>
#include "deep_cubemap/extents.glsl"

restrict writeonly buffer NewFragments { OverlapFragment new_fragments[]; };

void add_fragment(uint index, ivec2 cell, int side_exponent, uint triangle, uvec2 depths, uvec2 extent) {
    ivec4 within = extent_in_tile(extent, cell, side_exponent + 2);
    uint touched = uint((within.z - within.x + 1) * (within.w - within.y + 1));
    atomicMax(cubemap_cells[index].near_complement, ~depths.x);
    atomicMax(cubemap_cells[index].far, depths.y);
    atomicAdd(cubemap_cells[index].slices, touched);
    atomicAdd(cubemap_cells[index].content, 1u);
    // counted past the capacity as well, so that the host learns how much is needed
    uint slot = atomicAdd(deep_cubemap.fragment_count, 1u);
    if (slot < deep_cubemap.fragment_capacity) {
        new_fragments[slot] = OverlapFragment(index, triangle, depths.x, depths.y, extent.x, extent.y);
    }
}
