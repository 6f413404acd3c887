#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Decides how many depth bins each cell gets and where they lie.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"

layout(std430, binding = 4) restrict readonly buffer BinnedCells { uint binned_cells[]; };

void main() {
    uint number = invocation_index();
    if (number >= deep_cubemap.binned_cell_count) return;
    uint index = binned_cells[number];
    int fragments = int(cubemap_cells[index].content & 0x3fffffffu);
    int wanted = min(1 << findMSB(fragments), int(deep_cubemap.most_bins));
    int slices = bitCount(cubemap_cells[index].slices), exponent = 0;
    while (exponent < 15 && slices << (exponent + 1) <= wanted << JOIN_MOST) ++exponent;
    cubemap_cells[index].content = pack_content(CELL_BINS, 0u, uint(exponent));
    uint start = atomicAdd(deep_cubemap.bin_count, uint(bins_total(cubemap_cells[index])) + 1u);
    cubemap_cells[index].content = pack_content(CELL_BINS, start, uint(exponent));
}
