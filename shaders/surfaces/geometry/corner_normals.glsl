// SPDX-License-Identifier: GPL-3.0-or-later
// Normals at the corners of triangles of placed meshes.
#include "common/geometry.glsl"

readonly buffer CornerNormals;

// By these normals are placed, whatever the scale.
mat3 cofactors_of(mat3 linear) {
    return mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
}

// A mirroring matrix turns the winding round.
bool is_mirroring(mat3 linear, mat3 cofactors) { return dot(linear[0], cofactors[0]) < 0.0; }

// The normal of a corner in the world, as TriangleAttributes have it. face: that of its triangle, of any length, for
// corners whose normal is 0, as those of flat faces are, or not finite.
uint placed_normal(uint corner, mat3 cofactors, bool mirrored, vec3 face) {
    uint at = 3u * corner;
    vec3 normal = cofactors * vec3(corner_normals[at], corner_normals[at + 1u], corner_normals[at + 2u]);
    if (mirrored) normal = -normal;
    float size = length(normal);
    return size > 0.0 && size < 1e30 ? pack_unit_vector(normal / size)
                                     : pack_unit_vector(face / max(length(face), 1e-30));
}
