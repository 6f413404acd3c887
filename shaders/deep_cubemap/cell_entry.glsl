// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of cells, for rays; see rppm_addon/gl/buffers/texel_buffers.py.
#include "deep_cubemap/entries.glsl"

#ifdef TEXEL_BUFFERS
layout(rgba32ui) restrict readonly uniform uimageBuffer CellEntries;
uvec2 cell_entry(uint place) {
    uvec4 two = imageLoad(CellEntries, int(place >> 1u));
    return (place & 1u) == 0u ? two.xy : two.zw;
}
#else
restrict readonly buffer CellEntries;
uvec2 cell_entry(uint place) { return cell_entries[place]; }
#endif
