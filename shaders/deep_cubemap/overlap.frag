#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: TRIANGLE_CLUSTERS=1
// lint: INSTANCE_BOXES=1
// A pixel is a cell of the job's rectangle; the test decides whether the triangle touches it.
#define DEEP_CUBEMAP_BUILD
#include <OverlapDraw>
uniform Parameters { OverlapDraw parameters; };
#include "deep_cubemap/classify.glsl"

flat in uint job_number;
flat in ivec2 tile_origin;

void main() { classify_cell(overlap_jobs[job_number], ivec2(gl_FragCoord.xy) - tile_origin); }
