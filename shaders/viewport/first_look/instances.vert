#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Instances of a mesh that are not expanded, one behind the other, flat and with the plain surface of their first
// material.

#include "common/placed_point.glsl"
#include "viewport/first_look/surface.glsl"
#include <InstanceEntry>
readonly buffer Triangles;
readonly buffer Instances { InstanceEntry instances[]; };
readonly buffer SlotMaterials { uint slot_materials[]; };
readonly buffer DrawnInstances;

vec3 world_point(InstanceEntry entry, uint vertex) {
    mat3 linear = transpose(mat3(entry.row0.xyz, entry.row1.xyz, entry.row2.xyz));
    vec3 origin = vec3(entry.row0.w, entry.row1.w, entry.row2.w);
    return placed_point(linear, origin, triangle_vertices[vertex].xyz - entry.pivot);
}

void main() {
    uint vertex = uint(gl_VertexID) % parameters.instance_vertices;
    uint number = drawn_instances[parameters.first_instance + uint(gl_VertexID) / parameters.instance_vertices];
    InstanceEntry entry = instances[number];
    uint first = parameters.first_vertex + vertex / 3u * 3u;
    vec3 v0 = world_point(entry, first), v1 = world_point(entry, first + 1u), v2 = world_point(entry, first + 2u);
    vec3 across = cross(v1 - v0, v2 - v0);
    uint corner = vertex % 3u;
    vec3 point = corner == 0u ? v0 : corner == 1u ? v1 : v2;
    place_vertex(point, across / max(length(across), 1e-30), slot_materials[entry.first_slot], number);
}
