#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Divides all cells down to the base level, and empties the base level's. A thread a tile.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/tiles.glsl"

void main() {
    uint tile = invocation_index();
    if (tile >= deep_cubemap.tile_count) return;
    // up to the root: four binary digits a level, the root's number at the end
    uint index = tile;
    ivec2 cell = ivec2(0);
    int shift = 0;
    for (; index >= deep_cubemap.root_count; shift += 2) {
        uint above = tile_of_cell(index), offset = index - first_cell_of_tile(above);
        cell |= ivec2(offset & 3u, offset >> 2) << shift;
        index = above;
    }
    uint side = 1u << deep_cubemap.root_exponent;
    cell |= ivec2(index % side, (index / side) % side) << shift;
    cubemap_tiles[tile] = pack_place(cell, int(index / (side * side)));
    cubemap_cells[tile] = CubemapCell(0u, 0u, 0u, pack_content(CELL_TILE, 0u, 0u) | first_cell_of_tile(tile));
    bool is_last = shift == 2 * (int(deep_cubemap.base_level) - 1);
    uint emptied = is_last ? 16u : 0u;
    for (uint child = 0u; child < emptied; ++child) {
        cubemap_cells[first_cell_of_tile(tile) + child] = CubemapCell(0u, 0u, 0u, 0u);
    }
}
