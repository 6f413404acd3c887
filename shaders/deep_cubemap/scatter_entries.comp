#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Writes fragments into their bins. Afterwards bin_ends[start + 1 + bin] is the bin's end.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/binned_fragments.glsl"
#include "deep_cubemap/entries.glsl"
restrict writeonly buffer CellEntries;

void main() {
    uint index = invocation_index();
    if (index >= deep_cubemap.binned_fragment_count) return;
    BinnedFragment fragment = binned_fragments[index];
    CubemapCell cell = cubemap_cells[fragment.cell];
    ivec2 bins = fragment_bins(fragment, cell);
    for (int bin = bins.x; bin <= bins.y; ++bin) {
        uint place = atomicAdd(bin_ends[content_start(cell.content) + 1u + uint(bin)], 1u);
        uint marks = (bin > bins.x ? ENTRY_IN_BIN_BEFORE : 0u) | (bin < bins.y ? ENTRY_IN_BIN_BEHIND : 0u);
        cell_entries[place] = uvec2(fragment.triangle | marks, fragment.depths);
    }
}
