#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Two triangles for each job, along the borders of its rectangle of cells. Pixels are cells: the six
// faces lie side by side in three columns and two rows. On pixel borders no rule of any rasterizer
// can lose a pixel, and faces need no scissor and no near plane.
#include <OverlapDraw>
layout(std140, binding = 0) uniform Parameters { OverlapDraw parameters; };
#include "deep_cubemap/jobs.glsl"

flat out uint job_triangle;
flat out int job_face;

const ivec2 CORNERS[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));

void main() {
    uvec4 job = overlap_jobs[parameters.first_job + uint(gl_VertexID) / 6u];
    job_triangle = job.x;
    job_face = int(job.y);
    ivec2 corner = CORNERS[gl_VertexID % 6];
    ivec2 cell = corner * (unpack_cell(job.w) + 1) + (1 - corner) * unpack_cell(job.z);
    vec2 pixel = vec2(ivec2(job_face % 3, job_face / 3) * int(parameters.resolution) + cell);
    gl_Position = vec4(pixel / (vec2(1.5, 1.0) * float(parameters.resolution)) - 1.0, 0.0, 1.0);
}
