// SPDX-License-Identifier: GPL-3.0-or-later
// The rectangle around a triangle as it is seen on a face, rounded outwards, in 1/65536 of the face's side:
// (least x | least y << 16, greatest x | greatest y << 16). Found once, it serves all levels.

const float EXTENT_STEPS = 65536.0;

// From positions on the face, 0 to 1. The float error of a division is far below the slack.
uvec2 pack_extent(vec2 low, vec2 high) {
    uvec2 least = uvec2(clamp(floor(low * EXTENT_STEPS - 0.125), 0.0, EXTENT_STEPS - 1.0));
    uvec2 greatest = uvec2(clamp(floor(high * EXTENT_STEPS + 0.125), 0.0, EXTENT_STEPS - 1.0));
    return uvec2(least.x | least.y << 16, greatest.x | greatest.y << 16);
}

// The rectangle around two.
uvec2 extent_around(uvec2 one, uvec2 other) {
    return uvec2(min(one.x & 0xffffu, other.x & 0xffffu) | min(one.x >> 16, other.x >> 16) << 16,
                 max(one.y & 0xffffu, other.y & 0xffffu) | max(one.y >> 16, other.y >> 16) << 16);
}

// First and last of the cells that it touches, each side of the face cut into 2^side_exponent.
ivec4 extent_cells(uvec2 extent, int side_exponent) {
    return ivec4(extent.x & 0xffffu, extent.x >> 16, extent.y & 0xffffu, extent.y >> 16) >> (16 - side_exponent);
}

// First and last of the cells of a tile that it touches, (x, y, x, y) from 0 to 3; at least one.
ivec4 extent_in_tile(uvec2 extent, ivec2 divided_cell, int side_exponent) {
    return clamp(extent_cells(extent, side_exponent) - 4 * divided_cell.xyxy, 0, 3);
}
