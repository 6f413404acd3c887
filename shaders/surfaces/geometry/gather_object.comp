#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Indexed meshes become triangles in object space. Each mesh has an entry as instances have.

layout(local_size_x = 64) in;

#include <GatherParameters>
#include "common/invocation.glsl"
#include "surfaces/geometry/mesh_arrays.glsl"
readonly buffer TriangleSlots;
uniform Parameters { GatherParameters parameters; };

void main() {
    uint index = invocation_index(), triangle = parameters.first_triangle + index;
    if (index >= parameters.triangle_count) return;
    InstanceEntry mesh = instances[instance_of(triangle, parameters.instance_count)];
    uint local = mesh.mesh_triangle + triangle - mesh.first_triangle, first_corner = 3u * local;
    vec3 points[3];
    bool finite = true;
    for (uint k = 0u; k < 3u; ++k) {
        uint corner = mesh.mesh_corner + triangle_corners[first_corner + k];
        points[k] = three_floats(mesh.mesh_vertex + corner_vertices[corner]);
        finite = finite && reasonable(points[k]);
    }
    // A triangle without finite corners becomes a point, which no ray meets. Fourth component of the first: its slot.
    for (uint k = 0u; k < 3u; ++k)
        triangle_vertices[3u * index + k] =
            vec4(finite ? points[k] : parameters.fallback_point, k == 0u ? float(triangle_slots[local]) : 0.0);
}
