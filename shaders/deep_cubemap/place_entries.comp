#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Turns counts into places: gives each cell with bins room for its entries and writes where each bin
// starts to bin_ends[start + 1 + bin], from where scattering moves it on to the bin's end.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/binned_cells.glsl"

void main() {
    uint index = invocation_index();
    if (index >= deep_cubemap.binned_cell_count) return;
    CubemapCell cell = cubemap_cells[binned_cells[index].cell];
    uint start = content_start(cell.content), count = uint(bins_total(cell));
    uint total = 0u;
    for (uint bin = 1u; bin <= count; ++bin) total += bin_ends[start + bin];
    uint place = atomicAdd(deep_cubemap.entry_count, total);
    bin_ends[start] = place;
    for (uint bin = 1u; bin <= count; ++bin) {
        uint number = bin_ends[start + bin];
        bin_ends[start + bin] = place;
        place += number;
    }
}
