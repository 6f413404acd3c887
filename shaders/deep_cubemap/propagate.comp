#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Propagates the fragments of a level, a thread each: to the cell's list, to those that are binned later,
// or to the tile that divides the cell. A triangle that lies in one cell of the tile needs no test.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include <DivideLevel>
uniform Parameters { DivideLevel parameters; };
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/tiles.glsl"
#include "deep_cubemap/binned_cells.glsl"
#include "deep_cubemap/entries.glsl"
restrict writeonly buffer CellEntries;
#include "deep_cubemap/add_job.glsl"
#include "deep_cubemap/fragments.glsl"

restrict readonly buffer OldFragments { OverlapFragment old_fragments[]; };
restrict writeonly buffer BinnedFragments;

void divide_fragment(OverlapFragment fragment, uint tile) {
    uvec2 extent = uvec2(fragment.extent_low, fragment.extent_high);
    ivec2 divided = place_cell(cubemap_tiles[tile]);
    int side_exponent = int(parameters.side_exponent) + 2;
    ivec4 within = extent_in_tile(extent, divided, side_exponent);
    if (within.xy == within.zw) {
        add_fragment(first_cell_of_tile(tile) + tile_offset(within.xy), 4 * divided + within.xy, side_exponent,
                     fragment.triangle, uvec2(fragment.near, fragment.far), extent);
    } else {
        add_job(fragment.triangle, tile, within, extent);
    }
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.fragment_count) return;
    OverlapFragment fragment = old_fragments[index];
    CubemapCell cell = cubemap_cells[fragment.cell];
    uvec2 depths = uvec2(fragment.near, fragment.far);
    uvec2 fractions = quantize_interval(depths, cell);
    uint quantized_depths = fractions.x | fractions.y << 16;
    uint slices = depth_slices(depths, cell);
    atomicOr(cubemap_cells[fragment.cell].slices, slices);
    if (content_kind(cell.content) == CELL_TILE) {
        divide_fragment(fragment, tile_of_cell(content_tile(cell.content)));
    } else if (content_kind(cell.content) == CELL_LIST) {
        uint content = atomicAdd(cubemap_cells[fragment.cell].content, 1u);
        uint place = content_start(content) + content_count(content);
        if (place < deep_cubemap.entry_capacity) { cell_entries[place] = uvec2(fragment.triangle, quantized_depths); }
    } else {
        uint number = binned_cell_number(cell.content);
        if (number < deep_cubemap.binned_cell_capacity) atomicAdd(binned_cells[number].slices, uint(bitCount(slices)));
        uint place = atomicAdd(deep_cubemap.propagated_binned_count, 1u);
        if (place < deep_cubemap.binned_fragment_capacity) {
            binned_fragments[place] = BinnedFragment(fragment.cell, fragment.triangle, quantized_depths);
        }
    }
}
