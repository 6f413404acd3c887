// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle of an instance's mesh becomes a world-space triangle.
#include "common/placed_point.glsl"
#include "surfaces/geometry/corner_normals.glsl"
#include "surfaces/geometry/mesh_arrays.glsl"

readonly buffer CornerUvs { vec2 corner_uvs[]; };
readonly buffer TriangleSlots;
readonly buffer SlotMaterials;
writeonly buffer Attributes;

#include <MeshArrays>

// Writes a triangle of the mesh of an instance, both by number, as the one at a place in Triangles and Attributes.
void gather_triangle(uint number, uint triangle, uint index, vec3 fallback_point) {
    InstanceEntry instance = instances[number];
    uint local = instance.mesh_triangle + triangle;
    mat3 linear = transpose(mat3(instance.row0.xyz, instance.row1.xyz, instance.row2.xyz));
    vec3 origin = vec3(instance.row0.w, instance.row1.w, instance.row2.w);
    mat3 cofactors = cofactors_of(linear);
    bool mirrored = is_mirroring(linear, cofactors);

    vec3 local_points[3], points[3];
    uint corners[3];
    bool finite = true;
    for (uint k = 0u; k < 3u; ++k) {
        corners[k] = instance.mesh_corner + triangle_corners[3u * local + (mirrored && k > 0u ? 3u - k : k)];
        local_points[k] = three_floats(instance.mesh_vertex + corner_vertices[corners[k]]) - instance.pivot;
        points[k] = placed_point(linear, origin, local_points[k]);
        finite = finite && reasonable(points[k]);
    }
    // In object space, where coordinates are not rounded as far from the world's origin.
    vec3 face = cofactors * cross(local_points[1] - local_points[0], local_points[2] - local_points[0]);
    uint normals[3];
    vec2 uvs[3];
    for (uint k = 0u; k < 3u; ++k) {
        normals[k] = placed_normal(corners[k], cofactors, mirrored, face);
        uvs[k] =
            instance.mesh_uv == NO_UV ? vec2(0.0) : corner_uvs[instance.mesh_uv + corners[k] - instance.mesh_corner];
    }
    // A triangle without finite corners becomes a point, which no ray meets. Fourth components: the sets that it is in
    // and whether it casts no shadow (common/light_sets.glsl); its chance among the emitters, and its traits as one
    // (lights/mark.comp).
    for (uint k = 0u; k < 3u; ++k)
        triangle_vertices[3u * index + k] =
            vec4(finite ? points[k] : fallback_point, k == 0u ? instance.set_code : 0.0);
    uint slot = min(triangle_slots[local], instance.slot_count - 1u);
    attributes[index] =
        TriangleAttributes(normals[0], normals[1], normals[2], slot_materials[instance.first_slot + slot], uvs[0],
                           uvs[1], uvs[2], number, triangle);
}
