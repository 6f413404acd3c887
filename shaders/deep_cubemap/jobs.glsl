// SPDX-License-Identifier: GPL-3.0-or-later
// Rectangles of cells that a triangle may touch on a face: (triangle, face, first cell, last cell),
// a cell as x | y << 16. No side is longer than deep_cubemap.job_size.

layout(std430, binding = 15) buffer OverlapJobs { uvec4 overlap_jobs[]; };

ivec2 unpack_cell(uint cell) { return ivec2(cell & 0xffffu, cell >> 16); }
uint pack_cell(ivec2 cell) { return uint(cell.x) | uint(cell.y) << 16; }
