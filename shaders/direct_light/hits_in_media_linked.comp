#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl MEDIA=1
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1 MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1 HETEROGENEOUS_MEDIA=1
// The nearest hit of each shadow ray on what may be in the way of its light, and does more than to bound
// a volume.
layout(local_size_x = 64) in;
#include "common/active_paths.glsl"
#include "common/light_sets.glsl"
#include <LightLink>
uvec2 shadow_sets;  // bits of those that are in the ray's way
#define SHADOW_LINKING
#define SHADOW_RAYS
#define NEAREST_SHADOW
#include <TraceParameters>
uniform Parameters { TraceParameters parameters; };
#include TRAVERSAL

restrict buffer ShadowRays;
restrict writeonly buffer Hits;
restrict buffer Contributions;
restrict readonly buffer LightLinks;
restrict readonly buffer LightTriangles;
#include "direct_light/pass_boundaries.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    target_triangle = light_triangles[index];
    shadow_sets = light_links[code_number(contributions[index].w)].shadow_sets;
    begin_path(parameters.first_hit + 2u * index);
    hits[index] = hit_behind_boundaries(index);
}
