#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: CLAMPS_LIGHT=1
// A pixel reuses the rays of its neighbors' final gather, within a radius that shrinks as all radii do.
//
// Bekaert, Sbert and Halton, Accelerating Path Tracing by Re-Using Paths (2002): a neighbor's ray is weighted by the
// probability density with which the pixel's own ray would have come to the same hit, over the neighbor's density. The
// hemisphere of a point is therefore not blurred with those of its neighbors, but visibility is taken to be the same.
// The balance heuristic weights the pixel's ray and that of each neighbor for a hit, as in pairwise MIS (Bitterli
// 2022). There the pixel's own ray stands for OWN_RAYS of all neighbors' taps, so that no neighbor's ray counts for
// more than taps / OWN_RAYS rays. It is worth more than one ray because the pixel's rays are distributed evenly over
// the iterations.

layout(local_size_x = 64) in;

#include <ReuseParameters>
#include <FinalGather>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/geometry.glsl"
#include "common/clamping.glsl"
#include "common/random.glsl"
uniform Parameters { ReuseParameters parameters; };
readonly buffer FinalGatherOrigins;
readonly buffer FinalGatherHits;
readonly buffer GatherRadiances;
buffer Radiances;

// The smallest cosine between the normals of two neighbors, and how far one may lie off the other's tangent plane, in
// radii. Normals must be nearer to each other than those of photons and importons.
const float REUSE_NORMAL_TOLERANCE = 0.9;
const float REUSE_PLANE_TOLERANCE = 0.35;
const float OWN_RAYS = 4.0;
// Rotation by the golden angle, from one tap to the next.
const mat2 GOLDEN_ROTATION = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);

struct SurfacePoint {
    vec3 position;
    vec3 normal;
};

SurfacePoint gather_hit(uint index) {
    return SurfacePoint(final_gather_hits[index].position, unpack_unit_vector(final_gather_hits[index].normal));
}

// Terms of the density with which diffuse rays from one point come to another, per area: the product of both cosines
// with the squared distance, and the squared distance. scale: of lengths.
vec2 geometry_terms(vec3 position, vec3 normal, SurfacePoint hit, float scale) {
    vec3 ray = (hit.position - position) * scale;
    return vec2(max(dot(normal, ray), 0.0) * max(-dot(hit.normal, ray), 0.0), dot(ray, ray));
}

// Balance heuristic for a hit: the density with which rays from a pixel's own point come to it, over the sum of the
// neighbor's density and own_rays times that. From the geometry_terms of both.
float balance_weight(vec2 own_terms, vec2 other_terms, float own_rays) {
    float own = own_terms.x * other_terms.y * other_terms.y;
    return own > 0.0 ? own / (other_terms.x * own_terms.y * own_terms.y + own_rays * own) : 0.0;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec3 position = final_gather_origins[index].position;
    float own_radius = final_gather_origins[index].reuse_radius;
    if (own_radius == NO_FINAL_GATHER) return;
    float radius = parameters.reuse_radius * own_radius;
    vec3 own = gather_radiances[index].rgb, normal = unpack_unit_vector(final_gather_origins[index].normal), sum = own;
    float weights = 1.0;
    uint taps = radius > 0.0 ? parameters.taps : 0u;
    float scale = 1.0 / max(radius, 1e-30), own_rays = OWN_RAYS / float(max(taps, 1u));
    SurfacePoint hit = gather_hit(index);
    vec2 own_terms = geometry_terms(position, normal, hit, scale);
    bool is_lit = own != vec3(0.0);
    // The neighbors are the same in all iterations, so that the rays of each of them fill its hemisphere evenly.
    vec4 u = progressive_random(iteration.seed, 0u, STAGE_GATHERING, 0u, parameters.first_pixel + index);
    ivec2 size = ivec2(parameters.width, parameters.count / parameters.width);
    ivec2 pixel = ivec2(index % parameters.width, index / parameters.width);
    vec2 direction = parameters.radius_in_pixels * vec2(cos(2.0 * PI * u.x), sin(2.0 * PI * u.x));
    for (uint tap = 0u; tap < taps; ++tap, direction = GOLDEN_ROTATION * direction) {
        ivec2 other_pixel = pixel + nearest_whole(sqrt((float(tap) + u.y) / float(taps)) * direction);
        if (other_pixel == pixel || any(lessThan(other_pixel, ivec2(0))) || any(greaterThanEqual(other_pixel, size)))
            continue;
        uint other = uint(other_pixel.y) * parameters.width + uint(other_pixel.x);
        vec3 other_position = final_gather_origins[other].position;
        if (!(final_gather_origins[other].reuse_radius > 0.0)) continue;
        vec3 apart = (other_position - position) * scale;
        float distance2 = dot(apart, apart);
        if (distance2 >= 1.0 || abs(dot(apart, normal)) > REUSE_PLANE_TOLERANCE) continue;
        vec3 other_normal = unpack_unit_vector(final_gather_origins[other].normal);
        if (dot(normal, other_normal) < REUSE_NORMAL_TOLERANCE) continue;
        float kernel = 1.0 - distance2;
        weights += kernel;
        vec3 radiance = gather_radiances[other].rgb;
        if (radiance != vec3(0.0)) {
            SurfacePoint other_hit = gather_hit(other);
            vec2 other_terms = geometry_terms(other_position, other_normal, other_hit, scale);
            sum +=
                radiance
                * (kernel * balance_weight(geometry_terms(position, normal, other_hit, scale), other_terms, own_rays));
        }
        if (is_lit) {
            vec2 other_terms = geometry_terms(other_position, other_normal, hit, scale);
            sum += own * (kernel * own_rays * balance_weight(own_terms, other_terms, own_rays));
        }
    }
    radiances[index].rgb += clamped_light(final_gather_origins[index].weight * sum / weights, 1u);
}
