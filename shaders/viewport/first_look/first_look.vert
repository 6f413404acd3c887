#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The world triangles with the plain surfaces of their materials.

#include "common/geometry.glsl"
#include "viewport/first_look/surface.glsl"
readonly buffer Triangles;
readonly buffer Attributes;

void main() {
    uint triangle = uint(gl_VertexID) / 3u, corner = uint(gl_VertexID) % 3u;
    TriangleAttributes shading = attributes[triangle];
    vec3 corner_normal = unpack_unit_vector(corner == 0u   ? shading.normal0
                                            : corner == 1u ? shading.normal1
                                                           : shading.normal2);
    place_vertex(triangle_vertices[gl_VertexID].xyz, corner_normal, shading.material, shading.instance);
}
