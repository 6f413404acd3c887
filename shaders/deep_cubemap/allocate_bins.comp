#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Decides how many depth bins each cell gets and where they lie: about as many as it holds triangles, yet no
// more than let a triangle lie in few of them.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/binned_cells.glsl"

const int FEW_BINS = 2;

void main() {
    uint number = invocation_index();
    if (number >= deep_cubemap.binned_cell_count) return;
    BinnedCell binned = binned_cells[number];
    int slices = bitCount(cubemap_cells[binned.cell].slices);
    int wanted = min(1 << findMSB(binned.fragments), int(deep_cubemap.max_bins));
    wanted = max(min(wanted, int(float(FEW_BINS * slices) * float(binned.fragments) / float(binned.slices))), 1);
    int exponent = 0;
    while (exponent < 15 && slices << (exponent + 1) <= wanted << MAX_JOIN) ++exponent;
    cubemap_cells[binned.cell].content = pack_content(CELL_BINS, 0u, uint(exponent));
    uint start = atomicAdd(deep_cubemap.bin_count, uint(bins_total(cubemap_cells[binned.cell])) + 1u);
    cubemap_cells[binned.cell].content = pack_content(CELL_BINS, start, uint(exponent));
}
