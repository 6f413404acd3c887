#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl MEDIA=1
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1 MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl INSTANCED_EMITTERS=1 MEDIA=1 HITS=media/two_levels
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl TEXEL_BUFFERS=1 MEDIA=1 HITS=media/two_levels
// The nearest hit of each shadow ray on what casts shadows and does more than to bound a volume.
layout(local_size_x = 64) in;
#include "common/active_paths.glsl"
#define SHADOW_RAYS
#define NEAREST_SHADOW
#include <TraceParameters>
uniform Parameters { TraceParameters parameters; };
#include TRAVERSAL

restrict buffer ShadowRays;
restrict writeonly buffer Hits;
restrict readonly buffer LightTriangles;
restrict buffer Contributions;
#include "direct_light/pass_boundaries.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    target_triangle = light_triangles[index];
    begin_path(parameters.first_hit + 2u * index);
    hits[index] = hit_behind_boundaries(index);
}
