#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What each gathering ray found: by next-event rays, and of photons.

layout(local_size_x = 64) in;

#include <FoundParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { FoundParameters parameters; };
#include "splatting/read_sums.glsl"
layout(std430, binding = 0) buffer FoundRadiances { vec4 found_radiances[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    found_radiances[index].rgb += read_sum(index, true) * parameters.quantum;
}
