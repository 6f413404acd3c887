// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow rays pass the surfaces that only bound volumes where they meet them: nothing there has to be resolved. The
// includer includes TRAVERSAL before, and declares the blocks ShadowRays and Contributions.

#include "common/iteration.glsl"
#include "common/geometry.glsl"
#include "direct_light/rest_of_ray.glsl"
#include <VolumeSurfaces>
readonly buffer Attributes;
readonly buffer Media;
buffer ShadowMedia;
#include "materials/medium.glsl"
#include HITS "media/one_level/hits.glsl"

// Media that let less of a shadow ray pass than this between two surfaces end it by russian roulette.
const float LEAST_PASSING = 0.1;

// How far a ray goes at most: farther on, the roulette ends it even by what is the same everywhere.
float roulette_reach(vec3 extinction, float u) {
    float least = min(extinction.x, min(extinction.y, extinction.z));
    return least > 0.0 ? -log(max(LEAST_PASSING * u, 1e-30)) / least : INFINITY_DISTANCE;
}

float survival(vec3 transmittance) { return min(largest(transmittance) / LEAST_PASSING, 1.0); }

// The rest of a ray behind a boundary that it has met.
Ray ray_behind(Ray ray, Hit hit, vec3 v0, vec3 v1, vec3 v2, vec3 normal, bool leaves) {
    vec3 position = (1.0 - hit.b1 - hit.b2) * v0 + hit.b1 * v1 + hit.b2 * v2;
    float offset = ray_offset(normal, v0, v1, v2);
    return rest_of_ray(ray, position + (leaves ? offset : -offset) * normal, hit.triangle);
}

// The nearest hit of a path's shadow ray on what is no boundary. The ray then begins behind the last boundary, in the
// media there, and its contribution has lost what the media before took.
Hit hit_behind_boundaries(uint index) {
    Ray ray = shadow_rays[index];
    uint flags = shadow_media[index];
    vec3 weight = vec3(1.0);
    Hit hit;
    for (int count = 0; count <= MOST_VOLUME_SURFACES; ++count) {
        float u = unit_float(pcg4d(uvec4(floatBitsToUint(ray.origin), iteration.seed + iteration.number)).x);
        float reach = ray.maximum_distance;
        vec3 extinction = even_extinction(flags);
        ray.maximum_distance = min(reach, roulette_reach(extinction, u));
        hit = nearest_hit(ray);
        bool free = hit.triangle == NO_TRIANGLE;
        if (free && ray.maximum_distance < reach) {
            weight = vec3(0.0);
            break;
        }
        ray.maximum_distance = reach;
        uint material = free ? 0u : material_of(hit.triangle);
        if (free || media[material].bounds_volume == 0u || count == MOST_VOLUME_SURFACES) {
            weight /= survival(exp(-extinction * (free ? reach : hit.distance)));
            break;
        }
        vec3 passing = segment_transmittance(flags, ray.origin, ray.direction, hit.distance);
        weight *= passing / max(survival(passing), 1e-30);
        if (!(u < survival(passing)) || !(largest(weight) > 0.0)) {
            weight = vec3(0.0);
            break;
        }
        vec3 v0 = triangle_vertex(3u * hit.triangle).xyz, v1 = triangle_vertex(3u * hit.triangle + 1u).xyz,
             v2 = triangle_vertex(3u * hit.triangle + 2u).xyz;
        vec3 normal = normalize(cross(v1 - v0, v2 - v0));
        bool leaves = dot(normal, ray.direction) > 0.0;
        flags = cross_surface(flags, material, leaves);
        ray = ray_behind(ray, hit, v0, v1, v2, normal, leaves);
    }
    shadow_media[index] = flags;
    contributions[index].rgb *= weight;
    if (weight == vec3(0.0)) ray.maximum_distance = 0.0;
    shadow_rays[index] = ray;
    return hit;
}
