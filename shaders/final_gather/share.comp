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

// Density with which a ray from a vertex arrives at a hit, over that of another vertex.
struct Densities { float own; float other; };

float cosines(vec3 normal, vec3 way, vec3 hit_normal) {
    return max(dot(normal, way), 0.0) * max(-dot(hit_normal, way), 0.0);
}

// Times the same factor.
Densities densities(vec3 own, vec3 own_normal, vec3 other, vec3 other_normal, vec3 hit, vec3 hit_normal, float scale) {
    vec3 a = (hit - own) * scale, b = (hit - other) * scale;
    float a2 = dot(a, a), b2 = dot(b, b);
    return Densities(cosines(own_normal, a, hit_normal) * b2 * b2, cosines(other_normal, b, hit_normal) * a2 * a2);
}

// 1 / (other / own + part), 0 where both are none.
float balanced(float own, float other, float part) {
    return own > 0.0 ? own / (other + part * own) : 0.0;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    GatheringVertex vertex = gathering_vertices[index];
    if (vertex.shared_radius < 0.0) return;
    float radius = parameters.shared_radius * vertex.shared_radius;
    vec3 own = found_radiances[index].rgb, sum = own, normal = unpack_unit_vector(vertex.normal);
    float total = 1.0;
    uint taps = radius > 0.0 ? parameters.taps : 0u;
    float part = 1.0 / float(max(taps, 1u));
    vec4 turn = progressive_random(parameters.seed, 0u, STAGE_GATHERING, 0u,
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
        vec3 other_normal = unpack_unit_vector(other.normal);
        if (dot(normal, other_normal) < SHARED_NORMAL_TOLERANCE) continue;
        float share = 1.0 - distance2;
        total += share;
        vec3 found = found_radiances[other_index].rgb;
        Densities there = densities(vertex.position, normal, other.position, other_normal, other.hit,
                                    unpack_unit_vector(other.hit_normal), 1.0 / radius);
        Densities here = densities(vertex.position, normal, other.position, other_normal, vertex.hit,
                                   unpack_unit_vector(vertex.hit_normal), 1.0 / radius);
        sum += share * (found * balanced(there.own, there.other, part)
                        + own * part * balanced(here.own, here.other, part));
    }
    radiances[index].rgb += vertex.weight * sum / total;
}
