// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/geometry.glsl"

// The mean of the normals of a triangle's corners by barycentrics, of any length. The includer declares before the
// block Attributes.
vec3 triangle_normal(uint triangle, vec3 b) {
    return b.x * unpack_unit_vector(attributes[triangle].normal0)
           + b.y * unpack_unit_vector(attributes[triangle].normal1)
           + b.z * unpack_unit_vector(attributes[triangle].normal2);
}
