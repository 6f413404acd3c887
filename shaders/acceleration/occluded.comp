#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1
// lint: TRAVERSAL=bvh/traverse.glsl
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl INSTANCED_EMITTERS=1
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl
// Whether each ray is free (1) or meets something (0) that is not the triangle that it goes to.
layout(local_size_x = 64) in;
#include "common/active_paths.glsl"
#define SHADOW_RAYS
#include TRAVERSAL

restrict readonly buffer Rays;
restrict writeonly buffer Visibility;
restrict readonly buffer LightTriangles;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray ray = rays[index];  // a copy: NVIDIA's compiler hands no member of a restricted block to a function
    target_triangle = light_triangles[index];
    visibility[index] = is_occluded(ray) ? 0u : 1u;
}
