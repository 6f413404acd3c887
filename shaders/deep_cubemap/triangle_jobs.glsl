// SPDX-License-Identifier: GPL-3.0-or-later
// What kernels that list jobs do with a triangle.
#include "common/finite.glsl"
#include "acceleration/triangles.glsl"
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
    vec3 outside = max(max(min(min(a, b), c), -max(max(a, b), c)), vec3(0.0));  // the box's nearest point
    float reach = 1.01 * deep_cubemap.core_radius;
    if (dot(outside, outside) >= reach * reach) return;
    uint index = atomicAdd(deep_cubemap.core_count, 1u);
    if (index < deep_cubemap.core_capacity) core_triangles[index] = triangle;
}

// `triangle`: or a cluster.
void list_jobs(uint triangle, int face, uvec2 extent) {
    int side_exponent = int(deep_cubemap.root_exponent) + 2 * int(deep_cubemap.base_level);
    ivec4 cells = extent_cells(extent, side_exponent);
    ivec4 tiles = cells >> 2;
    for (ivec2 divided = tiles.xy; divided.y <= tiles.w; ++divided.y) {
        for (divided.x = tiles.x; divided.x <= tiles.z; ++divided.x) {
            uint tile =
                dense_cell_index(face, divided, int(deep_cubemap.base_level) - 1, 1 << deep_cubemap.root_exponent);
            add_job(triangle, tile, extent_in_tile(extent, divided, side_exponent), extent);
        }
    }
}

struct Corners {
    vec3 a, b, c;
};

// About the center.
Corners corners_of(uint triangle) {
    uint first = 3u * (deep_cubemap.first_triangle + triangle);
    return Corners(triangle_vertices[first].xyz - deep_cubemap.center,
                   triangle_vertices[first + 1u].xyz - deep_cubemap.center,
                   triangle_vertices[first + 2u].xyz - deep_cubemap.center);
}

bool is_finite(Corners corners) { return is_finite(corners.a) && is_finite(corners.b) && is_finite(corners.c); }

bool is_within_core(Corners corners) {
    float farthest = max(max(dot(corners.a, corners.a), dot(corners.b, corners.b)), dot(corners.c, corners.c));
    float core_inside = 0.98 * deep_cubemap.core_radius;
    return farthest < core_inside * core_inside;
}

bool face_extent(Corners corners, int face, out uvec2 extent) {
    return face_extent(to_face(corners.a, face), to_face(corners.b, face), to_face(corners.c, face),
                       deep_cubemap.margin, extent);
}
