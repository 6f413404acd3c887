#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the entries of each bin, one place up: bin_ends[start + 1 + bin].
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/binned_fragments.glsl"

void main() {
    uint index = invocation_index();
    if (index >= deep_cubemap.binned_fragment_count) return;
    BinnedFragment fragment = binned_fragments[index];
    CubemapCell cell = cubemap_cells[fragment.cell];
    ivec2 bins = fragment_bins(fragment, cell);
    for (int bin = bins.x; bin <= bins.y; ++bin) atomicAdd(bin_ends[content_start(cell.content) + 1u + uint(bin)], 1u);
}
