#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What the cells above the base level hold, from the tile below each. Level by level, upwards.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include <MergeLevel>
uniform Parameters { MergeLevel parameters; };
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/tiles.glsl"

void main() {
    uint index = parameters.first_cell + invocation_index();
    if (index >= parameters.end_cell) return;
    uint first = first_cell_of_tile(index);
    CubemapCell merged = cubemap_cells[index];
    for (uint child = 0u; child < parameters.tile_cells; ++child) {
        merged.near_complement = max(merged.near_complement, cubemap_cells[first + child].near_complement);
        merged.far = max(merged.far, cubemap_cells[first + child].far);
    }
    for (uint child = 0u; child < parameters.tile_cells; ++child) {
        CubemapCell cell = cubemap_cells[first + child];
        if (cell.slices == 0u) continue;
        uint near = ~cell.near_complement;
        float size = float(cell.far - near) / 32.0;
        for (int slice = 0; slice < 32; ++slice) {
            if ((cell.slices >> slice & 1u) == 0u) continue;
            // a hundredth of a slice covers rounding
            vec2 ends = size * (float(slice) + vec2(-0.01, 1.01));
            merged.slices |= depth_slices(near + uvec2(max(ends, vec2(0.0))), merged);
        }
    }
    cubemap_cells[index] = merged;
}
