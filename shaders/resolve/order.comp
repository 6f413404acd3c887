#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The hits' numbers into the ranges of their programs.

layout(local_size_x = 64) in;

#include "common/constants.glsl"
#include "common/living_paths.glsl"
layout(std430, binding = 0) readonly buffer Rays;
layout(std430, binding = 1) readonly buffer Hits;
layout(std430, binding = 4) readonly buffer Attributes;
layout(std430, binding = 5) readonly buffer Materials;
#include "resolve/ranges.glsl"

void main() {
    uint index = living_path();
    if (index == NO_PATH) return;
    uint triangle = hits[index].triangle;
    if (!(rays[index].maximum_distance > 0.0) || triangle == NO_TRIANGLE) return;
    uint program = materials[attributes[triangle].material].program;
    hit_order[range_first(program) + atomicAdd(hit_order[RANGE_SIZE * program + 2u], 1u)] = index;
}
