#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A soft light faces each point that it lights with a disk. Photons leave its sphere; those whose
// ray back from the first hit misses the disk that faces the hit carry nothing.

layout(local_size_x = 64) in;

#include <Ray>
#include <Hit>
#include <PhotonPath>
#include <SoftFalloffParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { SoftFalloffParameters parameters; };
#include "emission/lights.glsl"
layout(std430, binding = 0) buffer Rays { Ray rays[]; };
layout(std430, binding = 1) readonly buffer Hits { Hit hits[]; };
layout(std430, binding = 2) writeonly buffer PhotonPaths { PhotonPath photon_paths[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    Light light = lights[light_of(index)];
    Hit hit = hits[index];
    if ((light.flags & LIGHT_SOFT) == 0u || hit.triangle == NO_TRIANGLE) return;
    Ray ray = rays[index];
    if (soft_light_distance(light, ray.origin + hit.distance * ray.direction, -ray.direction) > 0.0) return;
    photon_paths[index].flux = vec3(0.0);
    rays[index].maximum_distance = 0.0;
}
