// SPDX-License-Identifier: GPL-3.0-or-later
// An attribute where a Raycast hit, 0 without a hit. triangle: as the record of the ray has it (NodeRay), its last
// component 0 without a hit. In texts that trace no rays, as those of volumes, nothing is hit.

#include "materials/nodes/geometry.glsl"

void node_cast_attribute(Surface surface, uint layer, vec3 triangle, vec3 barycentrics, out vec3 color, out vec3 vector,
                         out float fac, out float alpha) {
    color = vector = vec3(0.0);
    fac = alpha = 0.0;
#ifdef NODE_RAYS
    if (triangle.z > 0.0) {
        uint mixed = uint(triangle.y), mesh_triangle = uint(triangle.x) | mixed << 24u;
        surface.instance = mixed >> 8u | (uint(triangle.z) - 1u) << 16u;
        uvec2 place = attribute_place(surface, layer);
        attribute_outputs(attribute_within(place, mesh_triangle, barycentrics), place, color, vector, fac, alpha);
    }
#endif
}
