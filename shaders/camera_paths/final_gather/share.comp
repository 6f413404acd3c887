#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A pixel takes over what the gathering rays of its neighbors found, within a radius that shrinks as all do.
//
// Bekaert, Sbert and Halton, Accelerating Path Tracing by Re-Using Paths (2002): a neighbor's ray counts by how much
// likelier the pixel's own one would have come to the same place, so what a hemisphere sees otherwise from there is not
// blurred; but visibility is taken over. Each neighbor and the pixel share places by the balance heuristic, as in
// pairwise MIS (Bitterli 2022): the pixel's own ray stands for OWN_RAYS of all neighbors' taps, so that no neighbor's
// counts for more than taps / OWN_RAYS. What a pixel's own rays find is spread evenly, so it is worth more than one.

layout(local_size_x = 64) in;

#include <ShareParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/geometry.glsl"
#include "common/random.glsl"
#include "common/gathering.glsl"
uniform Parameters { ShareParameters parameters; };
readonly buffer GatheringVertices;
readonly buffer GatherRadiances;
vec4 place_of(uint index) { return vec4(gathering_vertices[index].position, gathering_vertices[index].shared_radius); }
uint normal_of(uint index) { return gathering_vertices[index].normal; }
vec3 weight_of(uint index) { return gathering_vertices[index].weight; }
uvec4 hit_of(uint index) {
    return uvec4(floatBitsToUint(gathering_vertices[index].hit), gathering_vertices[index].hit_normal);
}
vec3 found_by(uint index) { return gather_radiances[index].rgb; }
buffer Radiances;

// How far the normals of neighbors may part, as a cosine, and how far one may lie off the other's tangent plane in
// radii. Normals must be nearer to each other than those of photons and importons.
const float SHARED_NORMAL_TOLERANCE = 0.9;
const float SHARED_PLANE_TOLERANCE = 0.35;
const float OWN_RAYS = 4.0;
// By the golden angle.
const mat2 GOLDEN_ROTATION = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);

// Where a ray arrived, by its place and the normal there.
struct Hit {
    vec3 place;
    vec3 normal;
};

Hit unpack_hit(uvec4 bits) { return Hit(uintBitsToFloat(bits.xyz), unpack_unit_vector(bits.w)); }

// Both cosines of a ray from a vertex to a hit times its length, and the length's square.
vec2 flight(vec3 vertex, vec3 normal, Hit hit, float scale) {
    vec3 way = (hit.place - vertex) * scale;
    return vec2(max(dot(normal, way), 0.0) * max(-dot(hit.normal, way), 0.0), dot(way, way));
}

// Of what comes from a hit: the density with which rays from one vertex arrive there, over the sum of the other's and
// a part of that.
float balanced(vec2 flight, vec2 other, float part) {
    float own = flight.x * other.y * other.y;
    return own > 0.0 ? own / (other.x * flight.y * flight.y + part * own) : 0.0;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec4 vertex = place_of(index);
    if (vertex.w < 0.0) return;
    float radius = parameters.shared_radius * vertex.w;
    vec3 own = found_by(index), normal = unpack_unit_vector(normal_of(index)), sum = own;
    float total = 1.0;
    uint taps = radius > 0.0 ? parameters.taps : 0u;
    float scale = 1.0 / max(radius, 1e-30), part = OWN_RAYS / float(max(taps, 1u));
    Hit hit = unpack_hit(hit_of(index));
    vec2 own_flight = flight(vertex.xyz, normal, hit, scale);
    bool found_own = own != vec3(0.0);
    // The same neighbors in all iterations, so that what each of them finds fills its hemisphere evenly.
    vec4 turn = progressive_random(iteration.seed, 0u, STAGE_GATHERING, 0u, parameters.first_pixel + index);
    ivec2 size = ivec2(parameters.width, parameters.count / parameters.width);
    ivec2 pixel = ivec2(index % parameters.width, index / parameters.width);
    vec2 direction = parameters.radius_in_pixels * vec2(cos(2.0 * PI * turn.x), sin(2.0 * PI * turn.x));
    for (uint tap = 0u; tap < taps; ++tap, direction = GOLDEN_ROTATION * direction) {
        ivec2 other_pixel = pixel + nearest_whole(sqrt((float(tap) + turn.y) / float(taps)) * direction);
        if (other_pixel == pixel || any(lessThan(other_pixel, ivec2(0))) || any(greaterThanEqual(other_pixel, size)))
            continue;
        uint other_index = uint(other_pixel.y) * parameters.width + uint(other_pixel.x);
        vec4 other = place_of(other_index);
        if (!(other.w > 0.0)) continue;
        vec3 apart = (other.xyz - vertex.xyz) * scale;
        float distance2 = dot(apart, apart);
        if (distance2 >= 1.0 || abs(dot(apart, normal)) > SHARED_PLANE_TOLERANCE) continue;
        vec3 other_normal = unpack_unit_vector(normal_of(other_index));
        if (dot(normal, other_normal) < SHARED_NORMAL_TOLERANCE) continue;
        float share = 1.0 - distance2;
        total += share;
        vec3 found = found_by(other_index);
        if (found != vec3(0.0)) {
            Hit there = unpack_hit(hit_of(other_index));
            sum += found
                   * (share
                      * balanced(flight(vertex.xyz, normal, there, scale),
                                 flight(other.xyz, other_normal, there, scale), part));
        }
        if (found_own)
            sum += own * (share * part * balanced(own_flight, flight(other.xyz, other_normal, hit, scale), part));
    }
    radiances[index].rgb += weight_of(index) * sum / total;
}
