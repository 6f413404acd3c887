#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Places on triangles as seen from points: `samples` of each, with the solid angle.

layout(local_size_x = 64) in;

#include <SphericalTriangleParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
#include "common/spherical_triangle.glsl"
uniform Parameters { SphericalTriangleParameters parameters; };
readonly buffer Triangles { vec4 triangles[]; };
writeonly buffer Results { vec4 results[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint first = 4u * (index / parameters.samples);
    vec3 point = triangles[first].xyz;
    vec3 v0 = triangles[first + 1u].xyz, v1 = triangles[first + 2u].xyz, v2 = triangles[first + 3u].xyz;
    RandomSequence random = random_sequence(7u, 1u, 1u, 0u, index);
    float solid_angle = triangle_solid_angle(point, v0, v1, v2);
    vec3 toward =
        solid_angle > 0.0 ? sample_spherical_triangle(point, v0, v1, v2, solid_angle, next_random2(random)) : vec3(0.0);
    results[index] = vec4(toward, solid_angle);
}
