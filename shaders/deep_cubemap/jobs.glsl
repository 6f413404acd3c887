// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles to be found in the cells of a tile: (triangle, tile << 8 | rectangle, extent).
// The rectangle is of cells within the tile, two bits each for first x, first y, last x, last y.

layout(std430, binding = 2) buffer OverlapJobs { uvec4 overlap_jobs[]; };

uint job_tile(uvec4 job) { return job.y >> 8; }

ivec4 job_rectangle(uvec4 job) {
    return ivec4(job.y & 3u, (job.y >> 2) & 3u, (job.y >> 4) & 3u, (job.y >> 6) & 3u);
}

// Counted past the capacity as well, so that the host learns how much is needed.
void add_job(uint triangle, uint tile, ivec4 rectangle, uvec2 extent) {
    uint slot = atomicAdd(deep_cubemap.job_count, 1u);
    if (slot >= deep_cubemap.job_capacity) return;
    uvec4 r = uvec4(rectangle);
    overlap_jobs[slot] = uvec4(triangle, tile << 8 | r.x | r.y << 2 | r.z << 4 | r.w << 6, extent);
}
