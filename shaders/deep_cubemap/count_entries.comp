#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the entries of each bin, one place up: bin_ends[start + 1 + bin].
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/fragment_bins.glsl"

void main() {
    uint index = invocation_index();
    if (index >= deep_cubemap.fragment_count) return;
    OverlapFragment fragment = overlap_fragments[index];
    CubemapCell cell = cubemap_cells[fragment.cell];
    uvec2 bins = fragment_bins(fragment, cell);
    for (uint bin = bins.x; bin <= bins.y; ++bin) atomicAdd(bin_ends[bins_start(cell.bins) + 1u + bin], 1u);
}
