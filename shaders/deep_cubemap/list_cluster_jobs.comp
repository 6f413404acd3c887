#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: TRIANGLE_CLUSTERS=1 MAX_CLUSTER_SIZE=4u
// What list_overlap_jobs.comp does, in clusters: a thread takes MAX_CLUSTER_SIZE triangles that follow each other, and
// lists those together that lie together. Those near the center are core triangles one by one.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include "deep_cubemap/triangle_jobs.glsl"
#include "deep_cubemap/clusters.glsl"

// The box around a cluster has at most so many times the surface of all boxes around its triangles.
const float MAX_LOOSENESS = 2.0;

float half_surface(vec3 box) { return dot(box, box.yzx); }

bool lie_together(uint first, uint size) {
    if (first + size > deep_cubemap.triangle_count) return false;
    vec3 low = vec3(1e30), high = vec3(-1e30);
    float sum = 0.0;
    for (uint triangle = first; triangle < first + size; ++triangle) {
        Corners corners = corners_of(triangle);
        if (!is_finite(corners)) return false;
        vec3 lowest = min(min(corners.a, corners.b), corners.c), highest = max(max(corners.a, corners.b), corners.c);
        low = min(low, lowest);
        high = max(high, highest);
        sum += half_surface(highest - lowest);
    }
    return half_surface(high - low) <= MAX_LOOSENESS * sum;
}

// Once for all faces: what every triangle adds to all of them.
void enter_triangles(uint first, uint size) {
    for (uint triangle = first; triangle < first + size; ++triangle) {
        Corners corners = corners_of(triangle);
        if (!is_finite(corners)) continue;
        widen_box(corners.a, corners.b, corners.c);
        list_core_triangle(triangle, corners.a, corners.b, corners.c);
    }
}

void list_cluster(uint first, uint size) {
    for (int face = 0; face < 6; ++face) {
        bool is_seen = false;
        uvec2 extent = uvec2(0u);
        for (uint triangle = first; triangle < first + size; ++triangle) {
            Corners corners = corners_of(triangle);
            uvec2 own;
            if (!is_finite(corners) || is_within_core(corners) || !face_extent(corners, face, own)) continue;
            extent = is_seen ? extent_around(extent, own) : own;
            is_seen = true;
        }
        if (is_seen) list_jobs(pack_cluster(first, size), face, extent);
    }
}

void main() {
    uint first = MAX_CLUSTER_SIZE * invocation_index();
    uint end = min(first + MAX_CLUSTER_SIZE, deep_cubemap.triangle_count);
    if (first >= end) return;
    enter_triangles(first, end - first);
    while (first < end) {
        uint size = MAX_CLUSTER_SIZE;
        while (size > 1u && (first % size != 0u || !lie_together(first, size))) size >>= 1;
        list_cluster(first, size);
        first += size;
    }
}
