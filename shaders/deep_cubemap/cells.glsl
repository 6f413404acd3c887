// SPDX-License-Identifier: GPL-3.0-or-later
// The cells, and above them blocks of 4 x 4, of 16 x 16 cells and so on: which depths hold triangles.
// All fields are such that zero means empty, and building only ever raises them:
//   near_complement  ~bits of the least depth (bits of positive floats sort as the floats do)
//   far              bits of the greatest depth
//   slices           which of 32 slices of the scene's depth are touched
//   bins             fragments in the cell while building; then see bins.glsl (cells only)
#include <CubemapCell>

#ifdef DEEP_CUBEMAP_BUILD
#define CUBEMAP_CELLS_ACCESS
#else
#define CUBEMAP_CELLS_ACCESS restrict readonly
#endif

layout(std430, binding = 10) CUBEMAP_CELLS_ACCESS buffer CubemapCells { CubemapCell cubemap_cells[]; };

// Level 0 are the cells; a level up, four times as many cells make a block's side.
// Levels above 0 each get room for as many blocks as the first of them has: that wastes little, and
// finding a level's start takes no division.
uint cell_index(int face, ivec2 block, int level, uint resolution) {
    uint side = resolution >> (2 * level);
    uint level_blocks = 6u * (resolution >> 2) * (resolution >> 2);
    uint level_start = level == 0 ? 0u : uint(15 + level) * level_blocks;
    return level_start + (uint(face) * side + uint(block.y)) * side + uint(block.x);
}

float nearest_depth(CubemapCell cell) { return uintBitsToFloat(~cell.near_complement); }
float farthest_depth(CubemapCell cell) { return uintBitsToFloat(cell.far); }

// The depth slices that [near, far] touches, a bit each. Monotone, so two intervals that overlap
// always share a bit.
uint depth_slices(float near, float far, float slices_per_metre) {
    uint first = uint(clamp(near * slices_per_metre, 0.0, 31.0));
    uint last = uint(clamp(far * slices_per_metre, 0.0, 31.0));
    return (0xffffffffu << first) & (0xffffffffu >> (31u - last));
}
