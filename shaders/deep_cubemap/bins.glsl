// SPDX-License-Identifier: GPL-3.0-or-later
// Depth bins. A cell's depth range is cut into 2^k equal bins by how much it holds. The cell's lists
// lie behind each other in bin_ends: list_start, end of bin 0 (= start of bin 1), end of bin 1, ...
// An entry is (triangle | continued, nearest depth | farthest depth), the depths as 16-bit fractions
// of the cell's range, rounded outwards. `continued` marks entries of a triangle that is already in
// the bin before: a walk over several bins tests it only once.

const uint CONTINUED = 0x80000000u;

#ifdef DEEP_CUBEMAP_BUILD
#define DEPTH_BINS_ACCESS
#else
#define DEPTH_BINS_ACCESS restrict readonly
#endif

layout(std430, binding = 11) DEPTH_BINS_ACCESS buffer DepthBins { uint bin_ends[]; };

// A cell's `bins` field: where its list begins in bin_ends, and the exponent of its bin count.
uint pack_bins(uint start, uint exponent) { return (start << 4) | exponent; }
uint bins_start(uint bins) { return bins >> 4; }
uint bins_count(uint bins) { return 1u << (bins & 15u); }

// First and last bin of a depth interval; (near, scale) map the cell's depths to [0, bin count].
uvec2 bins_between(vec2 interval, float near, float scale, uint count) {
    return uvec2(clamp((interval - near) * scale, vec2(0.0), vec2(float(count - 1u))));
}

float bin_scale(float near, float far, uint count) {
    return float(count) / max(far - near, 1e-30);
}

// Outward 16-bit fractions of a depth interval; one step of slack on both sides covers rounding.
uvec2 quantise_interval(vec2 interval, float near, float far) {
    vec2 fractions = (interval - near) * (65535.0 / max(far - near, 1e-30));
    return uvec2(clamp(vec2(floor(fractions.x) - 1.0, ceil(fractions.y) + 1.0), vec2(0.0), vec2(65535.0)));
}
