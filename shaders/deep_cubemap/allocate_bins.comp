#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Decides how many depth bins each cell gets and where they lie. A thread takes a few neighbouring
// cells in turn: their bins stay together, and no scan with barriers is needed.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/cell_runs.glsl"

const int MOST_BINS_EXPONENT = 6;

uint bins_exponent(uint fragments) {
    return fragments <= 2u ? 0u : uint(min(findMSB(fragments), MOST_BINS_EXPONENT));
}

// A list's start and one end a bin.
uint bins_room(uint fragments) {
    return fragments == 0u ? 0u : (1u << bins_exponent(fragments)) + 1u;
}

void main() {
    uvec2 run = cell_run(invocation_index());
    uint room = 0u;
    for (uint cell = run.x; cell < run.y; ++cell) room += bins_room(cubemap_cells[cell].bins);
    if (room == 0u) return;
    uint start = atomicAdd(deep_cubemap.bin_count, room);
    for (uint cell = run.x; cell < run.y; ++cell) {
        uint fragments = cubemap_cells[cell].bins;
        if (fragments == 0u) continue;
        cubemap_cells[cell].bins = pack_bins(start, bins_exponent(fragments));
        start += bins_room(fragments);
    }
}
