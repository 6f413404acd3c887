#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What a Raycast node tells at a level.

layout(local_size_x = 1) in;

#include <RaycastAnswerParameters>
uniform Parameters { RaycastAnswerParameters parameters; };
struct Surface {
    vec3 position;
};
vec3 world_position(Surface surface) { return surface.position + parameters.world_origin; }
#include "materials/node_rays.glsl"
#include "materials/nodes/raycast.glsl"
writeonly buffer Results { vec4 results[]; };

void main() {
    float is_hit, self_hit, hit_distance;
    vec3 hit_position, hit_normal, hit_triangle, hit_barycentrics;
    path_of_node_rays = 0u;
    node_raycast(Surface(vec3(0.0)), 0, 0u, 0u, vec3(0.0, 0.0, -3.0), vec3(0.0, 0.0, 1.0), 2.0, is_hit, self_hit,
                 hit_distance, hit_position, hit_normal, hit_triangle, hit_barycentrics);
    results[0] = vec4(hit_triangle, is_hit);
}
