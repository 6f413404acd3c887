#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The weight of photons in the kernel around points of rays in the grid of a medium, above a floor that ends it.

layout(local_size_x = 64) in;

#include <KernelTestParameters>
#include "common/geometry.glsl"
#include "common/invocation.glsl"
#include "common/iteration.glsl"
#include <Distances>
#include <Ray>
uniform Parameters { KernelTestParameters parameters; };
readonly buffer Media;
#include "materials/medium.glsl"
readonly buffer MediumVertices;
#include "media/photon_map/kernel.glsl"
readonly buffer TestRays { vec4 test_rays[]; };
writeonly buffer Results { vec4 results[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec4 start = test_rays[2u * index], way = test_rays[2u * index + 1u];
    Ray ray = Ray(start.xyz, 0u, way.xyz, way.w);
    MediumVertex segment = medium_vertices[index];
    uint flags = 1u << FIRST_MEDIUM;
    vec3 scattering = path_medium(flags, PlaceOnRay(ray.origin, ray.direction, start.w)).scattering;
    vec3 ratio = scattering_over_mean(flags, ray, segment, start.w, scattering, parameters.radius);
    results[index] = vec4(ratio / (1.0 - kernel_beyond_surfaces(ray, segment, start.w, parameters.radius)), 0.0);
}
