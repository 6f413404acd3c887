#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// How many hits each program is to resolve, and a range for them; misses become closures without a triangle.

layout(local_size_x = 64) in;

#include "common/constants.glsl"
#include "common/active_paths.glsl"
readonly buffer Rays;
readonly buffer Hits;
writeonly buffer Closures;
readonly buffer Attributes;
readonly buffer Materials;
#include <CountParameters>
uniform Parameters { CountParameters parameters; };  // count: of programs
#include "surfaces/resolve/ranges.glsl"

#include <Dispatch>

void count_hit(uint index) {
    uint triangle = hits[index].triangle;
    if (!(rays[index].maximum_distance > 0.0) || triangle == NO_TRIANGLE) {
        closures[index].triangle = NO_TRIANGLE;
        return;
    }
    atomicAdd(hit_order[range_of(materials[attributes[triangle].material].program) + 1u], 1u);
}

// A range for each program's hits, and the groups to dispatch.
void allocate_ranges() {
    uint first = range_of(parameters.count);
    for (uint program = 0u; program < parameters.count; ++program) {
        uint at = range_of(program);
        uint size = atomicAdd(hit_order[at + 1u], 0u);  // what other groups have counted, past this one's cache
        hit_order[at] = first;
        hit_order[at + 4u] = (size + GROUP_SIZE - 1u) / GROUP_SIZE;
        hit_order[at + 5u] = hit_order[at + 6u] = 1u;
        first += size;
    }
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    count_hit(index);
    memoryBarrierBuffer();
    if (atomicAdd(hit_order[COUNTED_PATHS], 1u) + 1u == active_header.count) allocate_ranges();
}
