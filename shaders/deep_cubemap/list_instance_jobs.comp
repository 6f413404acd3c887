#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What list_overlap_jobs.comp does, for the boxes of instances, a thread each.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/triangle_jobs.glsl"
#include "deep_cubemap/instance_boxes.glsl"

void main() {
    uint number = invocation_index();
    if (number >= deep_cubemap.triangle_count) return;
    InstanceBox box = instance_box(number);
    if (!is_finite(box.low) || !is_finite(box.high)) return;
    widen_box(box.low, box.high, box.high);
    list_core_triangle(number, box.low, box.high, box.high);
    vec3 farthest = max(abs(box.low), abs(box.high));
    if (is_within_core(Corners(farthest, farthest, farthest))) return;
    for (int face = 0; face < 6; ++face) {
        bool is_seen = false;
        uvec2 extent = uvec2(0u);
        for (uint side = 0u; side < deep_cubemap.box_triangles; ++side) {
            Corners corners;
            box_triangle(box, side, corners.a, corners.b, corners.c);
            uvec2 own;
            if (!face_extent(corners, face, own)) continue;
            extent = is_seen ? extent_around(extent, own) : own;
            is_seen = true;
        }
        if (is_seen) list_jobs(number, face, extent);
    }
}
