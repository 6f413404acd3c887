#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A pixel is a cell of the job's rectangle; the test decides whether the triangle touches it.
#define DEEP_CUBEMAP_BUILD
#include "deep_cubemap/classify.glsl"

flat in uint job_triangle;
flat in int job_face;

void main() {
    ivec2 face_origin = ivec2(job_face % 3, job_face / 3) * int(deep_cubemap.resolution);
    classify_cell(job_triangle, job_face, ivec2(gl_FragCoord.xy) - face_origin);
}
