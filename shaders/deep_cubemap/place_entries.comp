#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Turns counts into places: gives each cell room for its entries and writes where each bin starts
// to bin_ends[start + 1 + bin], from where scattering moves it on to the bin's end.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/cell_runs.glsl"

void main() {
    uvec2 run = cell_run(invocation_index());
    uint total = 0u;
    for (uint cell = run.x; cell < run.y; ++cell) {
        if (cubemap_cells[cell].slices == 0u) continue;
        uint bins = cubemap_cells[cell].bins;
        for (uint bin = 1u; bin <= bins_count(bins); ++bin) total += bin_ends[bins_start(bins) + bin];
    }
    if (total == 0u) return;
    uint place = atomicAdd(deep_cubemap.entry_count, total);
    for (uint cell = run.x; cell < run.y; ++cell) {
        if (cubemap_cells[cell].slices == 0u) continue;
        uint bins = cubemap_cells[cell].bins;
        bin_ends[bins_start(bins)] = place;
        for (uint bin = 1u; bin <= bins_count(bins); ++bin) {
            uint count = bin_ends[bins_start(bins) + bin];
            bin_ends[bins_start(bins) + bin] = place;
            place += count;
        }
    }
}
