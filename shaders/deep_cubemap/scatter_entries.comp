#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Writes each fragment into its bins. Afterwards bin_ends[start + 1 + bin] is the bin's end.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/fragment_bins.glsl"
#include "deep_cubemap/entries.glsl"

void main() {
    uint index = invocation_index();
    if (index >= deep_cubemap.fragment_count) return;
    OverlapFragment fragment = overlap_fragments[index];
    CubemapCell cell = cubemap_cells[fragment.cell];
    uvec2 bins = fragment_bins(fragment, cell);
    uvec2 depths = quantise_interval(
        vec2(fragment.near, fragment.far), nearest_depth(cell), farthest_depth(cell));
    for (uint bin = bins.x; bin <= bins.y; ++bin) {
        uint place = atomicAdd(bin_ends[bins_start(cell.bins) + 1u + bin], 1u);
        cell_entries[place] = uvec2(fragment.triangle | (bin > bins.x ? CONTINUED : 0u), depths.x | depths.y << 16);
    }
}
