// SPDX-License-Identifier: GPL-3.0-or-later
readonly buffer LightTriangles;

// The triangle that a path's shadow ray goes to.
uint hit_number(uint path) { return light_triangles[path]; }
