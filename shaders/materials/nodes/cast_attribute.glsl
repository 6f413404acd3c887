// SPDX-License-Identifier: GPL-3.0-or-later
// An attribute where a Raycast hit, 0 without a hit. triangle: its lower 16 bits, the others, and 1 for a hit.

#include "materials/nodes/geometry.glsl"

void node_cast_attribute(Surface surface, uint layer, vec3 triangle, vec3 barycentrics, out vec3 color, out vec3 vector,
                         out float fac, out float alpha) {
    color = vector = vec3(0.0);
    fac = alpha = 0.0;
    if (triangle.z > 0.0) {
        surface.triangle = uint(triangle.x) | uint(triangle.y) << 16u;
        surface.instance = attributes[surface.triangle].instance;
        surface.barycentrics = barycentrics;
        node_attribute(surface, layer, color, vector, fac, alpha);
    }
}
