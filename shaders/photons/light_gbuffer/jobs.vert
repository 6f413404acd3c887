#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Two triangles for each job, along the borders of its rectangle of texels. Views lie side by side in rows. On pixel
// borders no rule of any rasterizer can lose a texel.
#include <LightGBufferParameters>
uniform Parameters { LightGBufferParameters parameters; };
#include "photons/light_gbuffer/jobs.glsl"
#include "common/quad_corners.glsl"

flat out uint job_number;
flat out ivec2 view_corner;

void main() {
    job_number = uint(gl_VertexID) / 6u;
    uvec4 job = light_jobs[job_number];
    view_corner = ivec2(parameters.side * uvec2(job.y % parameters.columns, job.y / parameters.columns));
    ivec2 corner = CORNERS[gl_VertexID % 6];
    vec2 pixel = vec2(view_corner + corner * (job_texel(job.w) + 1) + (1 - corner) * job_texel(job.z));
    vec2 picture = vec2(parameters.side * uvec2(parameters.columns, parameters.rows));
    gl_Position = vec4(2.0 * pixel / picture - 1.0, 0.0, 1.0);
}
