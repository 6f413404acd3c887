// SPDX-License-Identifier: GPL-3.0-or-later
// Depth bins of the cells that hold much and cannot be divided with gain. The slices of such a cell that
// anything touches are numbered, and 2^k of them make a bin, or each makes 2^k bins, by how much the cell
// holds. What lies between slices in use gets no bins.
// The lists lie behind each other in bin_ends: list_start, end of bin 0 (= start of bin 1), end of bin 1, ...

#ifdef DEEP_CUBEMAP_BUILD
#define DEPTH_BINS_ACCESS
#else
#define DEPTH_BINS_ACCESS restrict readonly
#endif

DEPTH_BINS_ACCESS buffer DepthBins { uint bin_ends[]; };

// The cell's content has the number of bins: 2^cut a slice, or one for 2^join slices.
#include <DepthBins>
int bins_cut(CubemapCell cell) { return max(int(content_count(cell.content)) - MAX_JOIN, 0); }
int bins_join(CubemapCell cell) { return max(MAX_JOIN - int(content_count(cell.content)), 0); }

int bins_total(CubemapCell cell) { return ((bitCount(cell.slices) << bins_cut(cell)) - 1 >> bins_join(cell)) + 1; }

// The bin of a part (depth_parts of 32 << cut); between slices in use the bin behind, or the one before.
int bin_of_part(int part, CubemapCell cell, bool before) {
    int cut = bins_cut(cell), slice = part >> cut;
    int first = bitCount(cell.slices & ((1u << slice) - 1u)) << cut;
    bool in_use = (cell.slices >> slice & 1u) != 0u;
    return first + (in_use ? part & ((1 << cut) - 1) : (before ? -1 : 0)) >> bins_join(cell);
}

// First and last bin of a depth interval that touches a slice in use, by its codes.
ivec2 bins_between(uvec2 codes, CubemapCell cell) {
    ivec2 parts = depth_parts(codes, cell, (32 << bins_cut(cell)) - 1);
    return ivec2(bin_of_part(parts.x, cell, false), bin_of_part(parts.y, cell, true));
}
