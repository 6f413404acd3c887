// SPDX-License-Identifier: GPL-3.0-or-later

// A point of a mesh in the world. `precise` makes all kernels compute the same floats, so that a triangle is the same
// whether it was placed beforehand or by the ray that meets it.
vec3 placed_point(mat3 linear, vec3 origin, vec3 point) {
    precise vec3 placed = linear * point + origin;
    return placed;
}
