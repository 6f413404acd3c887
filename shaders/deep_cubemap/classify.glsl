// SPDX-License-Identifier: GPL-3.0-or-later
// One cell of a job: the exact test, and the fragment it leaves behind.
#include "acceleration/triangles.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/tiles.glsl"
#include "deep_cubemap/jobs.glsl"
restrict readonly buffer OverlapJobs;
#include "deep_cubemap/fragments.glsl"
#include "deep_cubemap/faces.glsl"
#include "deep_cubemap/cone_overlap.glsl"
#include "deep_cubemap/clusters.glsl"

// Depth interval of a triangle within a cell; false if they do not touch.
bool triangle_depths(uint triangle, int face, vec4 bounds, out vec2 depths) {
    vec3 a = to_face(triangle_vertices[3u * triangle].xyz - deep_cubemap.center, face);
    vec3 b = to_face(triangle_vertices[3u * triangle + 1u].xyz - deep_cubemap.center, face);
    vec3 c = to_face(triangle_vertices[3u * triangle + 2u].xyz - deep_cubemap.center, face);
    return cone_depths(a, b, c, bounds, deep_cubemap.margin, depths);
}

void classify_cell(uvec4 job, ivec2 within) {
    uint place = cubemap_tiles[job_tile(job)];
    int face = place_face(place);
    ivec2 cell = 4 * place_cell(place) + within;
    int side_exponent = int(parameters.side_exponent);
    vec4 bounds = cell_bounds(cell, cell_size(side_exponent));
    vec2 depths;
#ifdef TRIANGLE_CLUSTERS
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
