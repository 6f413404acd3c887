#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A thread a triangle: culls it against the six faces, and lists it for those tiles of the base level
// that it may be seen through. A triangle that comes near the center is listed among the core triangles;
// if all of it is there, only there, for cells near the center are never walked.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "common/finite.glsl"
#include "deep_cubemap/triangles.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/core.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/add_job.glsl"
#include "deep_cubemap/faces.glsl"
#include "deep_cubemap/face_bounds.glsl"

void widen_box(vec3 a, vec3 b, vec3 c) {
    uvec3 low = ~sortable_bits(min(min(a, b), c)), high = sortable_bits(max(max(a, b), c));
    // most threads find that the box reaches as far already and need no atomic operation
    if (low.x > deep_cubemap.low_complement.x) atomicMax(deep_cubemap.low_complement.x, low.x);
    if (low.y > deep_cubemap.low_complement.y) atomicMax(deep_cubemap.low_complement.y, low.y);
    if (low.z > deep_cubemap.low_complement.z) atomicMax(deep_cubemap.low_complement.z, low.z);
    if (high.x > deep_cubemap.high.x) atomicMax(deep_cubemap.high.x, high.x);
    if (high.y > deep_cubemap.high.y) atomicMax(deep_cubemap.high.y, high.y);
    if (high.z > deep_cubemap.high.z) atomicMax(deep_cubemap.high.z, high.z);
}

void list_core_triangle(uint triangle, vec3 a, vec3 b, vec3 c) {
    vec3 outside = max(max(min(min(a, b), c), -max(max(a, b), c)), vec3(0.0)); // the box's nearest point
    float reach = 1.01 * deep_cubemap.core_radius;
    if (dot(outside, outside) >= reach * reach) return;
    uint index = atomicAdd(deep_cubemap.core_count, 1u);
    if (index < deep_cubemap.core_capacity) core_triangles[index] = triangle;
}

void list_jobs(uint triangle, int face, uvec2 extent) {
    int side_exponent = int(deep_cubemap.root_exponent) + 2 * int(deep_cubemap.base_level);
    ivec4 cells = extent_cells(extent, side_exponent);
    ivec4 tiles = cells >> 2;
    for (ivec2 divided = tiles.xy; divided.y <= tiles.w; ++divided.y) {
        for (divided.x = tiles.x; divided.x <= tiles.z; ++divided.x) {
            uint tile = dense_cell_index(face, divided, int(deep_cubemap.base_level) - 1,
                                         1 << deep_cubemap.root_exponent);
            add_job(triangle, tile, extent_in_tile(extent, divided, side_exponent), extent);
        }
    }
}

void main() {
    uint triangle = invocation_index();
    if (triangle >= deep_cubemap.triangle_count) return;
    vec3 a = triangle_vertices[3u * triangle].xyz - deep_cubemap.center;
    vec3 b = triangle_vertices[3u * triangle + 1u].xyz - deep_cubemap.center;
    vec3 c = triangle_vertices[3u * triangle + 2u].xyz - deep_cubemap.center;
    if (!is_finite(a) || !is_finite(b) || !is_finite(c)) return;
    widen_box(a, b, c);
    list_core_triangle(triangle, a, b, c);
    float farthest = max(max(dot(a, a), dot(b, b)), dot(c, c));
    float core_inside = 0.98 * deep_cubemap.core_radius;
    if (farthest < core_inside * core_inside) return;
    for (int face = 0; face < 6; ++face) {
        uvec2 extent;
        bool seen = face_extent(to_face(a, face), to_face(b, face), to_face(c, face), deep_cubemap.margin, extent);
        if (seen) list_jobs(triangle, face, extent);
    }
}
