#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: EMITTERS=lights/two_levels
// Where photons left emitters, or shadow rays found them, as hits of rays that look at the place. Others become
// inactive: emitters that shine evenly need not be asked.

layout(local_size_x = 64) in;

#include <Hit>
#include <EmittersParameters>
#include "common/constants.glsl"
#include "common/active_paths.glsl"
uniform Parameters { EmittersParameters parameters; };
readonly buffer Rays;
readonly buffer LightTriangles;
readonly buffer Triangles;
#include EMITTERS "lights/one_level/traits.glsl"
writeonly buffer EmitterRays { Ray emitter_rays[]; };
writeonly buffer EmitterHits { Hit emitter_hits[]; };

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray ray = rays[index];
    bool photons = parameters.photons != 0u;
    uint triangle = photons ? ray.source_triangle : light_triangles[index];
    emitter_rays[index] = Ray(ray.origin, NO_TRIANGLE, ray.direction, 0.0);
    emitter_hits[index] = Hit(NO_TRIANGLE, 0.0, 0.0, INFINITY_DISTANCE);
    if (triangle == NO_TRIANGLE || (emitter_traits(triangle) & EMITTER_UNEVEN) == 0u) return;
    vec3 v0 = triangle_vertices[3u * triangle].xyz;
    vec3 e1 = triangle_vertices[3u * triangle + 1u].xyz - v0, e2 = triangle_vertices[3u * triangle + 2u].xyz - v0;
    vec3 place = photons ? ray.origin : ray.origin + ray.maximum_distance * ray.direction;
    vec3 n = cross(e1, e2), offset = place - v0;
    float n2 = max(dot(n, n), 1e-30);
    vec2 b = clamp(vec2(dot(cross(offset, e2), n), dot(cross(e1, offset), n)) / n2, 0.0, 1.0);
    b /= max(1.0, b.x + b.y);
    emitter_rays[index] = Ray(ray.origin, NO_TRIANGLE, photons ? -ray.direction : ray.direction, INFINITY_DISTANCE);
    emitter_hits[index] = Hit(triangle, b.x, b.y, photons ? 0.0 : ray.maximum_distance);
}
