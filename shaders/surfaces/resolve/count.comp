#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// How many hits each program is to resolve; misses become closures without a triangle.

layout(local_size_x = 64) in;

#include "common/constants.glsl"
#include "common/active_paths.glsl"
readonly buffer Rays;
readonly buffer Hits;
writeonly buffer Closures;
readonly buffer Attributes;
readonly buffer Materials;
#include "surfaces/resolve/ranges.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    uint triangle = hits[index].triangle;
    if (!(rays[index].maximum_distance > 0.0) || triangle == NO_TRIANGLE) {
        closures[index].triangle = NO_TRIANGLE;
        return;
    }
    atomicAdd(hit_order[RANGE_SIZE * materials[attributes[triangle].material].program + 1u], 1u);
}
