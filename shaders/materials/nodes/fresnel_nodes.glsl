// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that weigh by the angle of view. `surface.viewer` is the unit direction to the viewer.
#include "materials/nodes/safe.glsl"

// Reflectance of unpolarized light by a dielectric (Cook and Torrance 1982); eta is the index of the far
// side over that of the near one.
float dielectric_reflectance(float cosine, float eta) {
    float c = abs(cosine), g2 = eta * eta - 1.0 + c * c;
    if (g2 <= 0.0) return 1.0;  // total reflection
    float g = sqrt(g2), a = (g - c) / (g + c), b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

void node_fresnel(Surface surface, float ior, vec3 normal, out float reflectance) {
    float eta = max(ior, 1e-5);
    reflectance = dielectric_reflectance(dot(surface.viewer, normal), surface.backfacing ? 1.0 / eta : eta);
}

void node_layer_weight(Surface surface, float blend, vec3 normal, out float fresnel, out float facing) {
    float cosine = dot(surface.viewer, normal);
    float eta = max(1.0 - blend, 1e-5);
    fresnel = dielectric_reflectance(cosine, surface.backfacing ? eta : 1.0 / eta);
    float weight = clamp(blend, 0.0, 1.0 - 1e-5);
    float exponent = weight < 0.5 ? 2.0 * weight : 0.5 / (1.0 - weight);
    facing = 1.0 - safe_power(abs(cosine), exponent);
}
