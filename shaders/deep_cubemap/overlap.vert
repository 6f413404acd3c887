#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Two triangles for each job, along the borders of its rectangle of cells. Pixels are cells, and tiles
// lie side by side in rows. On pixel borders no rule of any rasterizer can lose a pixel, and faces need
// no scissor and no near plane.
#define DEEP_CUBEMAP_BUILD
#include <OverlapDraw>
uniform Parameters { OverlapDraw parameters; };
#include "deep_cubemap/state.glsl"
#include "deep_cubemap/jobs.glsl"
restrict readonly buffer OverlapJobs;
#include "common/quad_corners.glsl"

flat out uint job_number;
flat out ivec2 tile_origin;

void main() {
    job_number = uint(gl_VertexID) / 6u;
    uvec4 job = overlap_jobs[job_number];
    // tiles of other drawings lie outside of the picture and are clipped
    int tile = int(job_tile(job)) - int(parameters.first_tile), row_tiles = int(parameters.picture_side) / 4;
    int row = tile < 0 ? -1 : tile / row_tiles;
    tile_origin = 4 * ivec2(tile < 0 ? 0 : tile % row_tiles, row);
    ivec4 rectangle = job_rectangle(job);
    ivec2 corner = CORNERS[gl_VertexID % 6];
    vec2 pixel = vec2(tile_origin + corner * (rectangle.zw + 1) + (1 - corner) * rectangle.xy);
    gl_Position = vec4(pixel / (0.5 * float(parameters.picture_side)) - 1.0, 0.0, 1.0);
}
