// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles to be found in the cells of a tile: (triangle, tile << 8 | rectangle, extent).
// The rectangle is of cells within the tile, two bits each for first x, first y, last x, last y.

uint job_tile(uvec4 job) { return job.y >> 8; }

ivec4 job_rectangle(uvec4 job) { return ivec4(job.y & 3u, (job.y >> 2) & 3u, (job.y >> 4) & 3u, (job.y >> 6) & 3u); }
