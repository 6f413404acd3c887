#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Every triangle against every ray: what the deep cubemap must equal bit for bit.
layout(local_size_x = 64) in;
#include "common/invocation.glsl"
#include "common/intersection.glsl"
#include <BruteForceParameters>
uniform Parameters { BruteForceParameters parameters; };
readonly buffer Rays;
writeonly buffer Hits;
readonly buffer Triangles;

void main() {
    uint index = parameters.first_ray + invocation_index();
    if (index >= parameters.end_ray) return;
    Ray ray = rays[index];
    WatertightRay test = make_watertight_ray(ray.origin, ray.direction);
    Hit best = Hit(NO_TRIANGLE, 0.0, 0.0, ray.maximum_distance);
    for (uint triangle = 0u; triangle < parameters.triangle_count; ++triangle) {
        if (triangle == ray.source_triangle) continue;
        intersect_triangle(test, triangle, triangle_vertices[3u * triangle].xyz,
                           triangle_vertices[3u * triangle + 1u].xyz, triangle_vertices[3u * triangle + 2u].xyz, best);
    }
    hits[index] = best;
}
