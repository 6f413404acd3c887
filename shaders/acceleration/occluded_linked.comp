#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1
// lint: TRAVERSAL=bvh/traverse.glsl
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl INSTANCED_EMITTERS=1
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl
// Whether each ray is free (1) or meets something (0) that may be in the way of the light that it goes to.
layout(local_size_x = 64) in;
#include "common/active_paths.glsl"
#include "common/light_sets.glsl"
#include <LightLink>
uvec2 shadow_sets;  // bits of those that are in the ray's way
#define SHADOW_LINKING
#define SHADOW_RAYS
#include TRAVERSAL

restrict readonly buffer Rays;
restrict writeonly buffer Visibility;
restrict readonly buffer Contributions;
restrict readonly buffer LightLinks;
restrict readonly buffer LightTriangles;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray ray = rays[index];  // a copy: NVIDIA's compiler hands no member of a restricted block to a function
    target_triangle = light_triangles[index];
    shadow_sets = light_links[code_number(contributions[index].w)].shadow_sets;
    if (shadow_sets == uvec2(0u)) visibility[index] = 1u;
    else visibility[index] = is_occluded(ray) ? 0u : 1u;
}
