#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: TEXEL_BUFFERS=1
// Whether each ray is free (1) or meets something (0).
layout(local_size_x = 64) in;
#include "common/living_paths.glsl"
#include "deep_cubemap/traverse.glsl"

layout(std430, binding = 1) restrict readonly buffer Rays;
layout(std430, binding = 2) restrict writeonly buffer Visibility;

void main() {
    uint index = living_path();
    if (index != NO_PATH) visibility[index] = deep_cubemap_occluded(rays[index]) ? 0u : 1u;
}
