#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The hits' numbers into the ranges of their programs.

layout(local_size_x = 64) in;

#include "common/constants.glsl"
#include "common/active_paths.glsl"
readonly buffer Rays;
readonly buffer Hits;
readonly buffer Attributes;
readonly buffer Materials;
#include "surfaces/resolve/ranges.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    uint triangle = hits[index].triangle;
    if (!(rays[index].maximum_distance > 0.0) || triangle == NO_TRIANGLE) return;
    uint program = materials[attributes[triangle].material].program;
    hit_order[range_first(program) + atomicAdd(hit_order[range_of(program) + 2u], 1u)] = index;
}
