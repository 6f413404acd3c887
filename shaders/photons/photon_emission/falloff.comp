#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What depends on where photons hit first. A soft light faces each point that it lights with a disk, while photons
// leave the one across their own direction: those whose ray back from the hit misses the former carry nothing. Light
// Falloff nodes count by the distance.

layout(local_size_x = 64) in;

#include <FalloffParameters>
#include "common/invocation.glsl"
uniform Parameters { FalloffParameters parameters; };
#include "lights/lights.glsl"
buffer Rays;
readonly buffer Hits;
buffer PhotonPaths;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    Light light = lights[light_of(index)];
    Hit hit = hits[index];
    bool soft = (light.flags & LIGHT_SOFT) != 0u;
    if (hit.triangle == NO_TRIANGLE || (!soft && light.falloff == 0.0 && light.smoothing == 0.0)) return;
    Ray ray = rays[index];
    photon_paths[index].flux *= distance_factor(light, hit.distance);
    if (!soft || soft_light_distance(light, ray.origin + hit.distance * ray.direction, -ray.direction) > 0.0) return;
    photon_paths[index].flux = vec3(0.0);
    rays[index].maximum_distance = 0.0;
}
