#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A quad of whole pixels for every splat job.

#include <QuadParameters>
#include "density_estimation/splatting/jobs.glsl"
uniform Parameters { QuadParameters parameters; };
readonly buffer Jobs;

flat out uint photon_number;
flat out uint face;

void main() {
    SplatJob job = jobs[gl_VertexID / 6];
    photon_number = job.photon;
    face = job.face;
    // Corners 0 1 2, 2 1 3 of the rectangle.
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
    uint x = (corner & 1) == 0 ? job.low & 0xffffu : job.high & 0xffffu;
    uint y = (corner & 2) == 0 ? job.low >> 16u : job.high >> 16u;
    gl_Position = vec4(2.0 * vec2(x, y) / vec2(parameters.width, parameters.height) - 1.0, 0.0, 1.0);
}
