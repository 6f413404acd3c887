#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest hit of each ray by a hierarchy of boxes: what the deep cubemap is measured against.
layout(local_size_x = 64) in;
#include "common/invocation.glsl"
#include "common/intersection.glsl"
#include <BoundingVolumesRange>
layout(std140, binding = 0) uniform Parameters { BoundingVolumesRange parameters; };
layout(std430, binding = 1) restrict readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 2) restrict writeonly buffer Hits { Hit hits[]; };
layout(std430, binding = 3) restrict readonly buffer Triangles { vec4 triangle_vertices[]; };
// Two vec4 a node: low and the bits of (first child or place in the order), high and of (triangles or 0).
layout(std430, binding = 4) restrict readonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 5) restrict readonly buffer Order { uint order[]; };

const int STACK = 64;

// Where the ray is within a node's box; the factor covers the rounding (Ize 2013).
vec2 clip_to_box(uint node, vec3 origin, vec3 inverse, float farthest) {
    vec3 a = (nodes[2u * node].xyz - origin) * inverse, b = (nodes[2u * node + 1u].xyz - origin) * inverse;
    vec3 near = min(a, b), far = max(a, b);
    return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), min(far.z, farthest)) * 1.0000005);
}

void main() {
    uint index = parameters.first_ray + invocation_index();
    if (index >= parameters.end_ray) return;
    Ray ray = rays[index];
    Hit best = Hit(NO_TRIANGLE, 0.0, 0.0, ray.maximum_distance);
    if (!(ray.maximum_distance > 0.0)) {
        hits[index] = best;
        return;
    }
    WatertightRay test = make_watertight_ray(ray.origin, ray.direction);
    vec3 inverse = 1.0 / mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
    uint stack[STACK];
    int height = 0;
    uint node = 0u;
    while (true) {
        uint first = floatBitsToUint(nodes[2u * node].w), count = floatBitsToUint(nodes[2u * node + 1u].w);
        bool down = false;
        if (count > 0u) {
            for (uint place = first; place < first + count; ++place) {
                uint triangle = order[place];
                if (triangle == ray.source_triangle) continue;
                intersect_triangle(
                    test, triangle, triangle_vertices[3u * triangle].xyz, triangle_vertices[3u * triangle + 1u].xyz,
                    triangle_vertices[3u * triangle + 2u].xyz, best);
            }
        } else {
            vec2 left = clip_to_box(first, ray.origin, inverse, best.distance);
            vec2 right = clip_to_box(first + 1u, ray.origin, inverse, best.distance);
            bool to_left = left.x <= left.y, to_right = right.x <= right.y;
            bool swap = to_right && (!to_left || right.x < left.x);
            if (to_left && to_right && height < STACK) stack[height++] = swap ? first : first + 1u;
            down = to_left || to_right;
            node = swap ? first + 1u : first;
        }
        if (down) continue;
        if (height == 0) break;
        node = stack[--height];
    }
    hits[index] = best;
}
