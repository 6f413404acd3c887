#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Decides what becomes of the cells of a level, a thread a tile: divided further, a short list, or a
// list in depth bins; and makes room for it. Counts go on past the capacities, so that the host
// learns how much is needed; it then starts over.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include <DivideLevel>
uniform Parameters { DivideLevel parameters; };
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/tiles.glsl"
#include "deep_cubemap/faces.glsl"
#include "deep_cubemap/binned_cells.glsl"

// Dividing pays off where the cells of the tile hold so many fewer triangles each that this outweighs the
// steps from one to the next; and where all of them together do not hold too much more.
const uint MAX_TOUCHED = 7u;

bool is_divisible(CubemapCell cell) {
    return parameters.level < deep_cubemap.last_level && cell.slices <= MAX_TOUCHED * cell.content
           && cell.slices + 16u * deep_cubemap.min_gain < 16u * cell.content;
}

// Whether the device can hold the fragments that dividing the cell may make; else it stays as it is.
bool has_room(CubemapCell cell) {
    return atomicAdd(deep_cubemap.reserved_count, cell.slices) + cell.slices <= deep_cubemap.fragment_limit;
}

// The bins themselves follow when it is known which depths are in use.
uint add_binned_cell(uint index, uint count) {
    uint number = atomicAdd(deep_cubemap.binned_cell_count, 1u);
    atomicAdd(deep_cubemap.binned_fragment_count, count);
    if (number < deep_cubemap.binned_cell_capacity) binned_cells[number] = BinnedCell(index, count, 0u);
    return CELL_BINS << 30 | number;
}

uint add_tile(uint tile, ivec2 cell, int face) {
    if (tile >= deep_cubemap.tile_capacity) return 0u;
    uint first = first_cell_of_tile(tile);
    cubemap_tiles[tile] = pack_place(cell, face);
    for (uint child = 0u; child < parameters.tile_cells; ++child)
        cubemap_cells[first + child] = CubemapCell(0u, 0u, 0u, 0u);
    return pack_content(CELL_TILE, 0u, 0u) | first;
}

void main() {
    uint tile = parameters.first_tile + invocation_index();
    if (tile >= parameters.end_tile) return;
    uint first = first_cell_of_tile(tile);
    uint divided = 0u, listed = 0u;
    for (uint child = 0u; child < parameters.tile_cells; ++child) {
        CubemapCell cell = cubemap_cells[first + child];
        if (is_divisible(cell) && has_room(cell)) {
            divided |= 1u << child;
        } else if (cell.content <= MAX_LISTED) {
            listed += cell.content;
        }
    }
    uint next_tile = divided == 0u ? 0u : atomicAdd(deep_cubemap.tile_count, uint(bitCount(divided)));
    uint next_entry = listed == 0u ? 0u : atomicAdd(deep_cubemap.entry_count, listed);
    uint place = cubemap_tiles[tile];
    for (uint child = 0u; child < parameters.tile_cells; ++child) {
        uint index = first + child;
        CubemapCell cell = cubemap_cells[index];
        uint count = cell.content;
        if (count == 0u) continue;
        uint content;
        if ((divided >> child & 1u) != 0u) {
            content = add_tile(next_tile++, 4 * place_cell(place) + ivec2(child & 3u, child >> 2), place_face(place));
        } else if (count <= MAX_LISTED) {
            content = pack_content(CELL_LIST, next_entry, 0u);  // counted up as the entries come
            next_entry += count;
        } else {
            content = add_binned_cell(index, count);
        }
        cubemap_cells[index].content = content;
        cubemap_cells[index].slices = 0u;
    }
}
