// SPDX-License-Identifier: GPL-3.0-or-later
// Of the two triangles of a rectangle, vertex by vertex.
const ivec2 CORNERS[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
