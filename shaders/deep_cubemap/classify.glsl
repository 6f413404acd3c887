// SPDX-License-Identifier: GPL-3.0-or-later
// One cell of a job: the exact test, and the fragment it leaves behind.
#include "deep_cubemap/state.glsl"
#ifdef INSTANCE_BOXES
#include "deep_cubemap/instance_boxes.glsl"
#else
#include "acceleration/triangles.glsl"
#endif
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/tiles.glsl"
#include "deep_cubemap/jobs.glsl"
restrict readonly buffer OverlapJobs;
#include "deep_cubemap/fragments.glsl"
#include "deep_cubemap/faces.glsl"
#include "deep_cubemap/cone_overlap.glsl"
#include "deep_cubemap/clusters.glsl"

#ifdef INSTANCE_BOXES
// Depth interval of an instance's box, which is solid, within a cell; false if they do not touch.
bool box_depths(uint number, int face, vec4 bounds, out vec2 depths) {
    InstanceBox box = instance_box(number);
    depths = vec2(1e30, -1e30);
    for (uint side = 0u; side < deep_cubemap.box_triangles; ++side) {
        vec3 a, b, c;
        box_triangle(box, side, a, b, c);
        vec2 interval;
        if (cone_depths(to_face(a, face), to_face(b, face), to_face(c, face), bounds, deep_cubemap.margin, interval))
            depths = vec2(min(depths.x, interval.x), max(depths.y, interval.y));
    }
    if (has_center(box)) depths.x = 0.0;
    return depths.x <= depths.y;
}
#else
// Depth interval of a triangle within a cell; false if they do not touch.
bool triangle_depths(uint triangle, int face, vec4 bounds, out vec2 depths) {
    uint first = 3u * (deep_cubemap.first_triangle + triangle);
    vec3 a = to_face(triangle_vertices[first].xyz - deep_cubemap.center, face);
    vec3 b = to_face(triangle_vertices[first + 1u].xyz - deep_cubemap.center, face);
    vec3 c = to_face(triangle_vertices[first + 2u].xyz - deep_cubemap.center, face);
    return cone_depths(a, b, c, bounds, deep_cubemap.margin, depths);
}
#endif

void classify_cell(uvec4 job, ivec2 within) {
    uint place = cubemap_tiles[job_tile(job)];
    int face = place_face(place);
    ivec2 cell = 4 * place_cell(place) + within;
    int side_exponent = int(parameters.side_exponent);
    vec4 bounds = cell_bounds(cell, cell_size(side_exponent));
    vec2 depths;
#if defined(INSTANCE_BOXES)
    if (!box_depths(job.x, face, bounds, depths)) return;
#elif defined(TRIANGLE_CLUSTERS)
    depths = vec2(1e30, -1e30);
    uint first = cluster_first(job.x), size = cluster_size(job.x);
    for (uint triangle = first; triangle < first + size; ++triangle) {
        vec2 interval;
        if (triangle_depths(triangle, face, bounds, interval))
            depths = vec2(min(depths.x, interval.x), max(depths.y, interval.y));
    }
    if (depths.x > depths.y) return;
#else
    if (!triangle_depths(job.x, face, bounds, depths)) return;
#endif
    add_fragment(first_cell_of_tile(job_tile(job)) + tile_offset(within), cell, side_exponent, job.x,
                 depth_codes(depths, deep_cubemap), job.zw);
}
