// SPDX-License-Identifier: GPL-3.0-or-later
// The bins that a fragment belongs to.
#include "deep_cubemap/cells.glsl"
#include "deep_cubemap/bins.glsl"
#include "deep_cubemap/fragments.glsl"

// First and last bin of the fragment in its cell.
uvec2 fragment_bins(OverlapFragment fragment, CubemapCell cell) {
    float near = nearest_depth(cell);
    uint count = bins_count(cell.bins);
    float scale = bin_scale(near, farthest_depth(cell), count);
    return bins_between(vec2(fragment.near, fragment.far), near, scale, count);
}
