#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A range for each program's hits, and the groups to dispatch.

layout(local_size_x = 1) in;

#include <CountParameters>
uniform Parameters { CountParameters parameters; };
#include "surfaces/resolve/ranges.glsl"

#include <Dispatch>

void main() {
    uint first = RANGE_SIZE * parameters.count;
    for (uint program = 0u; program < parameters.count; ++program) {
        uint at = RANGE_SIZE * program, size = hit_order[at + 1u];
        hit_order[at] = first;
        hit_order[at + 4u] = (size + GROUP_SIZE - 1u) / GROUP_SIZE;
        hit_order[at + 5u] = hit_order[at + 6u] = 1u;
        first += size;
    }
}
