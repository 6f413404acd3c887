#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Rays through the grids of media.

layout(local_size_x = 64) in;

#include <GridTestParameters>
#include "common/invocation.glsl"
#include "common/iteration.glsl"
#include <Distances>
uniform Parameters { GridTestParameters parameters; };
readonly buffer Media;
#include "materials/medium.glsl"
readonly buffer TestRays { vec4 test_rays[]; };
writeonly buffer Results { vec4 results[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec4 start = test_rays[2u * index], way = test_rays[2u * index + 1u];
    uint flags = parameters.media << FIRST_MEDIUM;
    vec3 passed;
    float flight = segment_free_flight(flags, start.xyz, way.xyz, start.w, 1, way.w, passed);
    results[4u * index] = vec4(segment_thickness(flags, start.xyz, way.xyz, start.w), flight);
    results[4u * index + 1u] = vec4(segment_emission(flags, start.xyz, way.xyz, start.w), 0.0);
    MediumCoefficients medium = path_medium(flags, PlaceOnRay(start.xyz, way.xyz, 0.5 * start.w));
    results[4u * index + 2u] = vec4(medium.absorption + medium.scattering, 0.0);
    results[4u * index + 3u] = vec4(lookup_offset(start.xyz, way.xyz), 0.0);
}
