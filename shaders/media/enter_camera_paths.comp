#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl MEDIA=1
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1 MEDIA=1
// lint: TRAVERSAL=bvh/traverse.glsl MEDIA=1
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl MEDIA=1 HITS=media/two_levels
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl TEXEL_BUFFERS=1 MEDIA=1 HITS=media/two_levels
// The media that camera paths begin in: those at the camera, and what lies on the way from there to where each ray
// begins. Texels have no camera: their paths come to the surface from before it, and those to the world from nowhere.

layout(local_size_x = 64) in;

#include <EnterMediaParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/camera_path.glsl"
uniform Parameters { EnterMediaParameters parameters; };
readonly buffer MediaOfSources;
readonly buffer Attributes;
readonly buffer Rays;
buffer CameraPaths;
readonly buffer Hits;
readonly buffer Media;
#include "media/crossings.glsl"

uint media_before(Ray ray, uint triangle) {
    if (triangle == NO_TRIANGLE) return 0u;
    vec3 v0 = triangle_vertex(3u * triangle).xyz, v1 = triangle_vertex(3u * triangle + 1u).xyz,
         v2 = triangle_vertex(3u * triangle + 2u).xyz;
    vec3 normal = normalize(cross(v1 - v0, v2 - v0));
    float offset = ray_offset(normal, v0, v1, v2);
    return media_at(ray.origin + (dot(normal, ray.direction) < 0.0 ? offset : -offset) * normal);
}

void main() {
    uint index = active_path();
    if (index == NO_PATH || !(rays[index].maximum_distance > 0.0)) return;
    Ray ray = rays[index];
    uint media = parameters.has_camera == 0u
                     ? media_before(ray, hits[index].triangle)
                     : media_beyond(parameters.camera_position, media_of_sources[iteration.light_count], ray.origin);
    camera_paths[index].flags |= media << FIRST_MEDIUM;
}
