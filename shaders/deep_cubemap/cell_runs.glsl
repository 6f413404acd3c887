// SPDX-License-Identifier: GPL-3.0-or-later
// The cells that a thread takes in turn: first, and one past the last.

const uint CELLS_PER_THREAD = 8u;

uvec2 cell_run(uint thread) {
    uint count = 6u * deep_cubemap.resolution * deep_cubemap.resolution;
    return min(uvec2(thread, thread + 1u) * CELLS_PER_THREAD, uvec2(count));
}
