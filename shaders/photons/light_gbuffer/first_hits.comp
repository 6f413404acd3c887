#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// DirectPhotonHits: photons test the triangles of their texels. What none of these settles is left to be traced.
layout(local_size_x = 64) in;

#include <FirstHitsParameters>
uniform Parameters { FirstHitsParameters parameters; };
#include "common/invocation.glsl"
#include "common/intersection.glsl"
#include "common/light_sets.glsl"
#include "lights/light_table.glsl"
#define TEXELS_ACCESS readonly
#include "photons/light_gbuffer/views.glsl"
#include "common/active_paths/kept.glsl"
#include "acceleration/triangles.glsl"
readonly buffer Rays;
writeonly buffer Hits;
readonly buffer TexelTriangles;
readonly buffer LightViewRanges { uvec2 view_ranges[]; };  // of each light: first, count

// The face of a cube, in the order of to_face (deep_cubemap/faces.glsl).
uint face_of(vec3 direction) {
    vec3 size = abs(direction);
    int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    return 2u * uint(axis) + (direction[axis] < 0.0 ? 1u : 0u);
}

// Whether the texel determines where a ray ends.
bool find_hit(Ray ray, uvec2 range, out Hit hit) {
    hit = Hit(NO_TRIANGLE, 0.0, 0.0, min(ray.maximum_distance, INFINITY_DISTANCE));
    uint number = range.x + (range.y == 6u ? face_of(ray.direction) : 0u);
    LightView view = light_views[number];
    vec3 toward = vec3(dot(ray.direction, view.right), dot(ray.direction, view.up), dot(ray.direction, view.forward));
    // Parallel light goes through one texel from where it is at the middle of the scene.
    if (view.tip_distance > 0.0) {
        vec3 start = view_point(view, ray.origin);
        toward = vec3(start.xy + toward.xy / toward.z * (view.tip_distance - start.z), view.tip_distance);
    }
    if (!(toward.z > 0.0)) return false;
    vec2 place = (toward.xy / (toward.z * view.tangent) * 0.5 + 0.5) * float(parameters.side);
    if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(parameters.side)))) return false;
    LightTexel texel = light_texels[texel_number(number, ivec2(place))];
    if (texel.count == 0u) return true;
    if (texel.count > MOST_TRIANGLES) return false;
    WatertightRay test = make_watertight_ray(ray.origin, ray.direction);
    for (uint place = texel.end - texel.count; place < texel.end; ++place) {
        uint triangle = texel_triangles[place];
        vec4 v0 = triangle_vertices[3u * triangle];
        vec3 v1 = triangle_vertices[3u * triangle + 1u].xyz, v2 = triangle_vertices[3u * triangle + 2u].xyz;
        if (is_one_sided(v0.w) && dot(cross(v1 - v0.xyz, v2 - v0.xyz), ray.direction) > 0.0) continue;
        intersect_triangle(test, triangle, v0.xyz, v1, v2, hit);
    }
    if (hit.triangle == NO_TRIANGLE) return false;
    float depth = view_point(view, ray.origin + hit.distance * ray.direction).z;
    return depth <= texel_horizon(view, texel);
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    Ray ray = rays[index];
    uvec2 range = view_ranges[light_of(index)];
    Hit hit;
    if (range.y == 0u || !(ray.maximum_distance > 0.0) || !find_hit(ray, range, hit)) keep_path(index);
    else hits[index] = hit;
}
