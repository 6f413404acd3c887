// SPDX-License-Identifier: GPL-3.0-or-later
// The tree of cells. Level 0 are the roots: root_side x root_side cells a face. A cell is divided into
// a tile of 4 x 4 cells where it holds much; down to the base level all are. Tile t holds the cells
// from root_count + 16 t on, row by row, and down to the base level tile t divides cell t.
// Of a cell are known:
//   near_complement  ~code of the least depth
//   far              code of the greatest depth
//   slices           which of 32 slices of the cell's own depth range are touched
//   content          0 if empty; else by its two upper bits
//                    CELL_LIST    a few triangles: where its entries begin << 4 | how many there are
//                    CELL_BINS    many: where its depth bins begin << 4 | log2 of the bins of a slice (bins.glsl)
//                    CELL_TILE    the first cell of its tile
// A depth's code are the bits of the float: they sort as the floats do and grow about as the logarithm,
// so that near things get finer slices than what lies far behind them.
// Zero means empty in all of them, and building only ever raises the first two.
// While a level is being built, `content` is the fragments in a cell and `slices` the cells of the
// next level that they might touch.
#include <CubemapCell>
#include "common/whole_numbers.glsl"

#ifdef DEEP_CUBEMAP_BUILD
#define CUBEMAP_CELLS_ACCESS
#else
#define CUBEMAP_CELLS_ACCESS restrict readonly
#endif

// By index; see rppm_addon/gl/buffers/texel_buffers.py.
#ifdef TEXEL_BUFFERS
layout(rgba32ui) restrict readonly uniform uimageBuffer CubemapCells;
CubemapCell cubemap_cell(uint index) {
    uvec4 words = imageLoad(CubemapCells, int(index));
    return CubemapCell(words.x, words.y, words.z, words.w);
}
#else
CUBEMAP_CELLS_ACCESS buffer CubemapCells { CubemapCell cubemap_cells[]; };
#ifndef DEEP_CUBEMAP_BUILD
CubemapCell cubemap_cell(uint index) { return cubemap_cells[index]; }
#endif
#endif

#include <CellKinds>
const uint MAX_LISTED = 6u;

uint content_kind(uint content) { return content >> 30; }
uint content_start(uint content) { return (content & 0x3fffffffu) >> 4; }
uint content_count(uint content) { return content & 15u; }
uint content_tile(uint content) { return content & 0x3fffffffu; }
uint pack_content(uint kind, uint start, uint count) { return kind << 30 | start << 4 | count; }

// A cell's place within its tile.
uint tile_offset(ivec2 cell) { return uint((cell.y & 3) << 2 | (cell.x & 3)); }

// Where a root, or a cell of a level that is divided everywhere, is stored.
uint dense_cell_index(int face, ivec2 cell, int level, int root_side) {
    int shift = 2 * level;
    uint root_count = uint(6 * root_side * root_side);
    uint index = uint((face * root_side + (cell.y >> shift)) * root_side + (cell.x >> shift));
    for (shift -= 2; shift >= 0; shift -= 2) index = root_count + 16u * index + tile_offset(cell >> shift);
    return index;
}

// Depths less than half of the core's radius are never walked; to separate them would waste slices.
uvec2 depth_codes(vec2 interval, DeepCubemapState cubemap) {
    return floatBitsToUint(max(interval, vec2(0.5 * cubemap.core_radius)));
}

// Where codes lie in a cell's depth range, as whole numbers from 0 to `last`. Monotone, so two intervals
// that overlap share a number. Codes are positive as int too.
ivec2 depth_parts(uvec2 codes, CubemapCell cell, int last) {
    int near = int(~cell.near_complement), far = int(cell.far);
    float scale = float(last + 1) / float(max(far - near, 1));
    return min(whole_part(vec2(clamp(ivec2(codes), near, far) - near) * scale), last);
}

// The slices of a cell's depth range that an interval touches, a bit each.
uint depth_slices(uvec2 codes, CubemapCell cell) {
    ivec2 slices = depth_parts(codes, cell, 31);
    return (0xffffffffu << slices.x) & (0xffffffffu >> (31 - slices.y));
}
