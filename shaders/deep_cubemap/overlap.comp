#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: TRIANGLE_CLUSTERS=1
// lint: INSTANCE_BOXES=1
// What overlap.vert and overlap.frag do, without the rasterizer. A group takes as many jobs as it has
// threads and distributes all their cells evenly, whatever the sizes of the rectangles.
layout(local_size_x = 64) in;
#define DEEP_CUBEMAP_BUILD
#include "common/invocation.glsl"
#include <OverlapDraw>
uniform Parameters { OverlapDraw parameters; };
#include "deep_cubemap/classify.glsl"

#include <Dispatch>
shared uint cells_up_to[GROUP_SIZE];  // of this job and those before it

// The job that the group's cell of a number belongs to.
uint job_of_cell(uint number) {
    uint job = 0u;
    for (uint stride = GROUP_SIZE / 2u; stride > 0u; stride /= 2u) {
        if (cells_up_to[job + stride - 1u] <= number) job += stride;
    }
    return job;
}

void main() {
    uint thread = gl_LocalInvocationIndex;
    uint group_start = invocation_index() - thread;
    uint cells = 0u;
    if (group_start + thread < parameters.job_count) {
        ivec4 rectangle = job_rectangle(overlap_jobs[group_start + thread]);
        cells = uint((rectangle.z - rectangle.x + 1) * (rectangle.w - rectangle.y + 1));
    }
    cells_up_to[thread] = cells;
    barrier();
    for (uint earlier = 0u; earlier < thread; ++earlier) cells += cells_up_to[earlier];
    barrier();
    cells_up_to[thread] = cells;
    barrier();
    for (uint number = thread; number < cells_up_to[GROUP_SIZE - 1u]; number += GROUP_SIZE) {
        uint index = job_of_cell(number);
        uvec4 job = overlap_jobs[group_start + index];
        uint within = number - (index == 0u ? 0u : cells_up_to[index - 1u]);
        ivec4 rectangle = job_rectangle(job);
        uint width = uint(rectangle.z - rectangle.x + 1);
        classify_cell(job, rectangle.xy + ivec2(within % width, within / width));
    }
}
