#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A pixel takes the mean of what the gathering rays of its neighbors found, within a radius that shrinks as all do.

layout(local_size_x = 64) in;

#include <ShareParameters>
#include "common/invocation.glsl"
#include "common/geometry.glsl"
#include "common/random.glsl"
#include "common/gathering.glsl"
layout(std140, binding = 0) uniform Parameters { ShareParameters parameters; };
layout(std430, binding = 0) readonly buffer GatheringVertices;
layout(std430, binding = 1) readonly buffer FoundRadiances;
layout(std430, binding = 2) buffer Radiances;

// How far the normals of neighbors may part, as a cosine, and how far one may lie off the other's tangent plane in
// radii. What a ray found was chosen by the cosine to its own normal and is taken over as it is, so normals must be
// nearer to each other than those of photons and importons.
const float SHARED_NORMAL_TOLERANCE = 0.9;
const float SHARED_PLANE_TOLERANCE = 0.35;
const float GOLDEN_ANGLE = 2.39996323;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    GatheringVertex vertex = gathering_vertices[index];
    if (vertex.shared_radius < 0.0) return;
    float radius = parameters.shared_radius * vertex.shared_radius;
    vec3 sum = found_radiances[index].rgb, normal = unpack_unit_vector(vertex.normal);
    float total = 1.0;
    uint taps = radius > 0.0 ? parameters.taps : 0u;
    vec4 turn = progressive_random(parameters.seed, parameters.iteration, STAGE_GATHERING, 0u,
                                   parameters.first_pixel + index);
    ivec2 size = ivec2(parameters.width, parameters.count / parameters.width);
    ivec2 pixel = ivec2(index % parameters.width, index / parameters.width);
    for (uint tap = 0u; tap < taps; ++tap) {
        float angle = 2.0 * PI * turn.x + GOLDEN_ANGLE * float(tap);
        vec2 offset = parameters.radius_in_pixels * sqrt((float(tap) + turn.y) / float(taps))
                      * vec2(cos(angle), sin(angle));
        ivec2 other_pixel = pixel + nearest_whole(offset);
        if (other_pixel == pixel || any(lessThan(other_pixel, ivec2(0))) || any(greaterThanEqual(other_pixel, size)))
            continue;
        uint other_index = uint(other_pixel.y) * parameters.width + uint(other_pixel.x);
        GatheringVertex other = gathering_vertices[other_index];
        if (!(other.shared_radius > 0.0)) continue;
        vec3 apart = other.position - vertex.position;
        float distance2 = dot(apart, apart) / (radius * radius);
        if (distance2 >= 1.0 || abs(dot(apart, normal)) > SHARED_PLANE_TOLERANCE * radius) continue;
        if (dot(normal, unpack_unit_vector(other.normal)) < SHARED_NORMAL_TOLERANCE) continue;
        float share = 1.0 - distance2;
        sum += share * found_radiances[other_index].rgb;
        total += share;
    }
    radiances[index].rgb += vertex.weight * sum / total;
}
