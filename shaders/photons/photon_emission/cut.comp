#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRAVERSAL=deep_cubemap/traverse.glsl
// lint: TRAVERSAL=deep_cubemap/traverse.glsl TEXEL_BUFFERS=1
// lint: TRAVERSAL=bvh/traverse.glsl
// lint: TRAVERSAL=bvh/traverse_two_levels.glsl
// lint: TRAVERSAL=deep_cubemap/traverse_two_levels.glsl
// Soft lights with surfaces near them face the point where a photon hits with a disk that the photon's ray meets a
// little behind where it began: what lies in between hides that place, as it does from shadow rays.

layout(local_size_x = 64) in;

#include "common/active_paths.glsl"
#include "lights/light_table.glsl"
#include <Lights>
#include <LightFlags>
#include TRAVERSAL
buffer Rays;
readonly buffer Hits;
buffer PhotonPaths;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Light light = lights[light_of(index)];
    const uint cut = LIGHT_SOFT | LIGHT_HOLDS_SURFACES;
    bool is_cut = (light.flags & (cut | LIGHT_SHADOWLESS)) == cut;
    Ray ray = rays[index];
    Hit hit = hits[index];
    if (!is_cut || hit.triangle == NO_TRIANGLE || !(ray.maximum_distance > 0.0)) return;
    vec3 point = ray.origin + hit.distance * ray.direction;
    float behind = soft_light_distance(light, point, -ray.direction) - hit.distance;
    if (!is_occluded(Ray(ray.origin, NO_TRIANGLE, -ray.direction, behind))) return;
    photon_paths[index].flux = vec3(0.0);
    rays[index].maximum_distance = 0.0;
}
