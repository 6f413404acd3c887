#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the blocks of one level of the hierarchy from the 4 x 4 blocks or cells below each.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include <MergeLevel>
layout(std140, binding = 0) uniform Parameters { MergeLevel parameters; };
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"

void main() {
    int level = int(parameters.level);
    uint side = deep_cubemap.resolution >> (2 * level);
    uint index = invocation_index();
    if (index >= 6u * side * side) return;
    ivec2 block = ivec2(index % side, (index / side) % side);
    int face = int(index / (side * side));
    CubemapCell merged = CubemapCell(0u, 0u, 0u, 0u);
    for (int child = 0; child < 16; ++child) {
        ivec2 place = 4 * block + ivec2(child & 3, child >> 2);
        CubemapCell cell = cubemap_cells[cell_index(face, place, level - 1, deep_cubemap.resolution)];
        merged.near_complement = max(merged.near_complement, cell.near_complement);
        merged.far = max(merged.far, cell.far);
        merged.slices |= cell.slices;
    }
    cubemap_cells[cell_index(face, block, level, deep_cubemap.resolution)] = merged;
}
