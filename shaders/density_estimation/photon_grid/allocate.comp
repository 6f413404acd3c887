#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A range for each bucket that holds any photon, or importon; the order of the ranges changes no sum.

layout(local_size_x = 64) in;

#include <AllocateParameters>
#include "common/invocation.glsl"
uniform Parameters { AllocateParameters parameters; };
buffer Buckets;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint size = buckets[index].y;
    if (size == 0u) return;
    uint first = atomicAdd(cursor, size);
    buckets[index] = uvec2(first, first);
}
