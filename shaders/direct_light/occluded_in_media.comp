#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl MEDIA=1
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1 MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl INSTANCED_EMITTERS=1 MEDIA=1 HITS=media/two_levels
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl TEXEL_BUFFERS=1 MEDIA=1 HITS=media/two_levels
// Whether each shadow ray is free (1) or meets something (0), and what media leave of its contribution, where light
// passes no surfaces but those that only bound volumes.
layout(local_size_x = 64) in;
#include "common/active_paths.glsl"
#define SHADOW_RAYS
#define NEAREST_SHADOW
#include TRAVERSAL

restrict buffer ShadowRays;
restrict writeonly buffer Visibility;
restrict readonly buffer LightTriangles;
restrict buffer Contributions;
#include "direct_light/pass_boundaries.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    target_triangle = light_triangles[index];
    bool free = hit_behind_boundaries(index).triangle == NO_TRIANGLE;
    visibility[index] = free ? 1u : 0u;
    if (!free) return;
    Ray ray = shadow_rays[index];
    contributions[index].rgb *=
        segment_transmittance(shadow_media[index], ray.origin, ray.direction, ray.maximum_distance);
}
