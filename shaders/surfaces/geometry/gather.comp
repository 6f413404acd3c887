#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Indexed meshes and their instances become world-space triangles.

layout(local_size_x = 64) in;

#include <InstanceEntry>
#include <GatherParameters>
#include "common/invocation.glsl"
#include "common/geometry.glsl"

uniform Parameters { GatherParameters parameters; };
readonly buffer Instances { InstanceEntry instances[]; };
readonly buffer Positions { float positions[]; };
readonly buffer CornerVertices { uint corner_vertices[]; };
readonly buffer CornerNormals { float corner_normals[]; };
readonly buffer CornerUvs { vec2 corner_uvs[]; };
readonly buffer TriangleCorners { uint triangle_corners[]; };
readonly buffer TriangleSlots { uint triangle_slots[]; };
readonly buffer SlotMaterials { uint slot_materials[]; };
writeonly buffer Triangles;
writeonly buffer Attributes;

#include <MeshArrays>

uint instance_of(uint triangle) {
    uint low = 0u, high = parameters.instance_count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (instances[middle].first_triangle <= triangle) low = middle;
        else high = middle - 1u;
    }
    return low;
}

vec3 three_floats(uint index) {
    return vec3(positions[3u * index], positions[3u * index + 1u], positions[3u * index + 2u]);
}

// By the bits, which no compiler may assume to be those of a number.
bool reasonable(vec3 p) { return all(lessThan(floatBitsToUint(p) & 0x7fffffffu, uvec3(floatBitsToUint(1e15)))); }

void main() {
    uint index = invocation_index(), triangle = parameters.first_triangle + index;
    if (index >= parameters.triangle_count) return;
    uint number = instance_of(triangle);
    InstanceEntry instance = instances[number];
    uint local = instance.mesh_triangle + triangle - instance.first_triangle;
    mat3 linear = transpose(mat3(instance.row0.xyz, instance.row1.xyz, instance.row2.xyz));
    vec3 origin = vec3(instance.row0.w, instance.row1.w, instance.row2.w);
    // Cofactors carry normals whatever the scale; a mirroring matrix turns the winding round.
    mat3 cofactors = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
    bool mirrored = dot(linear[0], cofactors[0]) < 0.0;

    vec3 local_points[3], points[3];
    uint corners[3];
    bool finite = true;
    for (uint k = 0u; k < 3u; ++k) {
        corners[k] = instance.mesh_corner + triangle_corners[3u * local + (mirrored && k > 0u ? 3u - k : k)];
        local_points[k] = three_floats(instance.mesh_vertex + corner_vertices[corners[k]]) - instance.pivot;
        points[k] = linear * local_points[k] + origin;
        finite = finite && reasonable(points[k]);
    }
    // In object space, where coordinates are not rounded as far from the world's origin.
    vec3 face = cofactors * cross(local_points[1] - local_points[0], local_points[2] - local_points[0]);
    uint normals[3];
    vec2 uvs[3];
    for (uint k = 0u; k < 3u; ++k) {
        uint at = 3u * corners[k];
        vec3 normal = cofactors * vec3(corner_normals[at], corner_normals[at + 1u], corner_normals[at + 2u]);
        if (mirrored) normal = -normal;
        float size = length(normal);
        // A normal of 0, as those of flat faces are, or one that is not finite gives way to the triangle's.
        normals[k] = size > 0.0 && size < 1e30 ? pack_unit_vector(normal / size)
                                               : pack_unit_vector(face / max(length(face), 1e-30));
        uvs[k] =
            instance.mesh_uv == NO_UV ? vec2(0.0) : corner_uvs[instance.mesh_uv + corners[k] - instance.mesh_corner];
    }
    // A triangle without finite corners becomes a point, which no ray meets. Fourth components: the sets that it is in
    // and whether it casts no shadow (common/light_sets.glsl); its chance among the emitters, and its traits as one
    // (lights/mark.comp).
    for (uint k = 0u; k < 3u; ++k)
        triangle_vertices[3u * index + k] =
            vec4(finite ? points[k] : parameters.fallback_point, k == 0u ? instance.set_code : 0.0);
    uint slot = min(triangle_slots[local], instance.slot_count - 1u);
    attributes[index] =
        TriangleAttributes(normals[0], normals[1], normals[2], slot_materials[instance.first_slot + slot], uvs[0],
                           uvs[1], uvs[2], number, 0u);
}
