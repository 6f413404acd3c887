// SPDX-License-Identifier: GPL-3.0-or-later
// One cell of a job: the exact test, and the fragment it leaves behind.
#include "deep_cubemap/triangles.glsl"
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/tiles.glsl"
#include "deep_cubemap/jobs.glsl"
layout(std430, binding = 2) restrict readonly buffer OverlapJobs;
#include "deep_cubemap/fragments.glsl"
#include "deep_cubemap/faces.glsl"
#include "deep_cubemap/cone_overlap.glsl"

void classify_cell(uvec4 job, ivec2 within) {
    uint triangle = job.x, place = cubemap_tiles[job_tile(job)];
    int face = place_face(place);
    ivec2 cell = 4 * place_cell(place) + within;
    vec3 a = to_face(triangle_vertices[3u * triangle].xyz - deep_cubemap.center, face);
    vec3 b = to_face(triangle_vertices[3u * triangle + 1u].xyz - deep_cubemap.center, face);
    vec3 c = to_face(triangle_vertices[3u * triangle + 2u].xyz - deep_cubemap.center, face);
    vec2 depths;
    int side_exponent = int(parameters.side_exponent);
    vec4 bounds = cell_bounds(cell, cell_size(side_exponent));
    if (!cone_depths(a, b, c, bounds, deep_cubemap.margin, depths)) return;
    add_fragment(
        first_cell_of_tile(job_tile(job)) + tile_offset(within), cell, side_exponent, triangle,
        depth_codes(depths, deep_cubemap), job.zw);
}
