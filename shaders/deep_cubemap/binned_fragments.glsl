// SPDX-License-Identifier: GPL-3.0-or-later
// The fragments of cells with depth bins, with depths as entries have them; and the bins that one belongs to.
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"

restrict readonly buffer BinnedFragments;

// First and last bin of the fragment in its cell.
ivec2 fragment_bins(BinnedFragment fragment, CubemapCell cell) {
    ivec2 parts = ivec2(fragment.depths & 0xffffu, fragment.depths >> 16) >> (11 - bins_cut(cell));
    return ivec2(bin_of_part(parts.x, cell, false), bin_of_part(parts.y, cell, true));
}
