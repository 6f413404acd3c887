// SPDX-License-Identifier: GPL-3.0-or-later
// Faces and cells. Face 2a + s looks along axis a, backwards if s = 1. In face coordinates z is the
// depth along that axis and x, y are lateral; a cell is the cone from the center through a square
// of the plane z = 1, where the face spans [-1, 1]^2.

vec3 to_face(vec3 v, int face) {
    int axis = face >> 1;
    vec3 turned = axis == 0 ? v.yzx : (axis == 1 ? v.zxy : v);
    if ((face & 1) != 0) turned.z = -turned.z;
    return turned;
}

// Of cells of which 2^side_exponent make a face's side: a power of two.
float cell_size(int side_exponent) { return uintBitsToFloat(uint(128 - side_exponent) << 23); }

// Where the borders of cells lie on the plane z = 1. The size is a power of two, so that this is exact
// and a border is the same number seen from both its sides and on all levels.
vec2 cell_border(ivec2 border, float cell_size) { return vec2(border) * cell_size - 1.0; }

// (least u, greatest u, least v, greatest v) of a cell.
vec4 cell_bounds(ivec2 cell, float cell_size) {
    return vec4(cell_border(cell, cell_size), cell_border(cell + 1, cell_size)).xzyw;
}
