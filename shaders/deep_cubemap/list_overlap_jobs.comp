#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A thread a triangle: culls it against the six faces, lists a rectangle of cells for each face that
// it may be seen through. A triangle that comes near the centre is listed among the core triangles;
// if all of it is there, only there, for cells near the centre are never walked.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "common/finite.glsl"
#include "deep_cubemap/triangles.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/core.glsl"
#include "deep_cubemap/jobs.glsl"
#include "deep_cubemap/faces.glsl"
#include "deep_cubemap/face_bounds.glsl"

void raise_greatest_depth(vec3 a, vec3 b, vec3 c) {
    vec3 farthest = max(max(abs(a), abs(b)), abs(c));
    uint bits = floatBitsToUint(max(max(farthest.x, farthest.y), farthest.z));
    // most threads find that the depth has been reached already and need no atomic operation
    if (bits > deep_cubemap.greatest_depth_bits) atomicMax(deep_cubemap.greatest_depth_bits, bits);
}

void list_core_triangle(uint triangle, vec3 a, vec3 b, vec3 c) {
    vec3 outside = max(max(min(min(a, b), c), -max(max(a, b), c)), vec3(0.0)); // the box's nearest point
    float reach = 1.01 * deep_cubemap.core_radius;
    if (dot(outside, outside) >= reach * reach) return;
    uint index = atomicAdd(deep_cubemap.core_count, 1u);
    if (index < deep_cubemap.core_capacity) core_triangles[index] = triangle;
}

// In rectangles of a limited size. Jobs are counted past the capacity as well, so that the host
// learns how much is needed.
void list_jobs(uint triangle, int face, ivec2 first, ivec2 last) {
    int size = int(deep_cubemap.job_size);
    ivec2 tiles = (last - first) / size + 1;
    uint index = atomicAdd(deep_cubemap.job_count, uint(tiles.x * tiles.y));
    for (ivec2 tile = ivec2(0); tile.y < tiles.y; ++tile.y) {
        for (tile.x = 0; tile.x < tiles.x; ++tile.x, ++index) {
            if (index >= deep_cubemap.job_capacity) return;
            ivec2 start = first + tile * size;
            overlap_jobs[index] = uvec4(triangle, face, pack_cell(start), pack_cell(min(start + size - 1, last)));
        }
    }
}

void main() {
    uint triangle = invocation_index();
    if (triangle >= deep_cubemap.triangle_count) return;
    vec3 a = triangle_vertices[3u * triangle].xyz - deep_cubemap.centre;
    vec3 b = triangle_vertices[3u * triangle + 1u].xyz - deep_cubemap.centre;
    vec3 c = triangle_vertices[3u * triangle + 2u].xyz - deep_cubemap.centre;
    if (!is_finite(a) || !is_finite(b) || !is_finite(c)) return;
    raise_greatest_depth(a, b, c);
    list_core_triangle(triangle, a, b, c);
    float farthest = max(max(dot(a, a), dot(b, b)), dot(c, c));
    float core_inside = 0.98 * deep_cubemap.core_radius;
    if (farthest < core_inside * core_inside) return;
    for (int face = 0; face < 6; ++face) {
        ivec2 first, last;
        bool seen = face_cells(
            to_face(a, face), to_face(b, face), to_face(c, face),
            deep_cubemap.margin, deep_cubemap.resolution, first, last);
        if (seen) list_jobs(triangle, face, first, last);
    }
}
