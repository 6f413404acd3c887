#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A thread a triangle: culls it against the six faces, and lists it for those tiles of the base level
// that it may be seen through. A triangle that comes near the center is listed among the core triangles;
// if all of it is there, only there, for cells near the center are never walked.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/triangle_jobs.glsl"

void main() {
    uint triangle = invocation_index();
    if (triangle >= deep_cubemap.triangle_count) return;
    Corners corners = corners_of(triangle);
    if (!is_finite(corners)) return;
    widen_box(corners.a, corners.b, corners.c);
    list_core_triangle(triangle, corners.a, corners.b, corners.c);
    if (is_within_core(corners)) return;
    for (int face = 0; face < 6; ++face) {
        uvec2 extent;
        if (face_extent(corners, face, extent)) list_jobs(triangle, face, extent);
    }
}
