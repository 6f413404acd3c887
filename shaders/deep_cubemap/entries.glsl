// SPDX-License-Identifier: GPL-3.0-or-later
// The lists themselves. An entry is (triangle or cluster | marks, nearest depth | farthest depth), the depths as
// 16-bit fractions of the cell's range, rounded outwards. The marks describe a triangle that is in the
// depth bin before or behind too: a walk over several bins tests it only once.

const uint ENTRY_IN_BIN_BEFORE = 0x80000000u;
const uint ENTRY_IN_BIN_BEHIND = 0x40000000u;
const uint ENTRY_TRIANGLE = 0x3fffffffu;

// Outward 16-bit fractions of a depth interval, by its codes; monotone, one step of slack on both sides
// covers rounding.
uvec2 quantize_interval(uvec2 codes, CubemapCell cell) {
    return uvec2(clamp(depth_parts(codes, cell, 65535) + ivec2(-1, 1), 0, 65535));
}
