#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What reached its light is added to the pixels' radiance.

layout(local_size_x = 64) in;

#include <CountParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { CountParameters parameters; };
layout(std430, binding = 0) readonly buffer Visibility { uint visibility[]; };
layout(std430, binding = 1) readonly buffer Contributions { vec4 contributions[]; };
layout(std430, binding = 2) buffer Radiances { vec4 radiances[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    if (visibility[index] != 0u) radiances[index] += contributions[index];
}
