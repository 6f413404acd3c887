// SPDX-License-Identifier: GPL-3.0-or-later
#include "deep_cubemap/jobs.glsl"

restrict writeonly buffer OverlapJobs;

// Counted past the capacity as well, so that the host learns how much is needed.
void add_job(uint triangle, uint tile, ivec4 rectangle, uvec2 extent) {
    uint slot = atomicAdd(deep_cubemap.job_count, 1u);
    if (slot >= deep_cubemap.job_capacity) return;
    uvec4 r = uvec4(rectangle);
    overlap_jobs[slot] = uvec4(triangle, tile << 8 | r.x | r.y << 2 | r.z << 4 | r.w << 6, extent);
}
