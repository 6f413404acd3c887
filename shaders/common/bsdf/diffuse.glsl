// SPDX-License-Identifier: GPL-3.0-or-later
// Diffuse surfaces under normal maps, and rough ones: Oren and Nayar's model in Fujii's improved form, with the light
// that facets pass on to each other (Portsmouth et al. 2024), as Cycles has it.

#include "common/geometry.glsl"

// Light that passes is scattered as if it had come from the mirrored direction. The lowest bit of blue.
const uint ROUGH_BEHIND = 0x10000u;

// Albedo (8 bits a channel) and roughness in one word; 0 is a smooth surface.
uint pack_diffuse_roughness(vec3 albedo, float roughness) {
    uint bits = packUnorm4x8(vec4(albedo, roughness));
    return bits < 0x01000000u ? 0u : bits & ~ROUGH_BEHIND;
}

// Integral of Fujii's facet term over the hemisphere, less its albedo at normal incidence.
float fujii_integral(float cosine) {
    float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
    // The last term is 2/3 tan (1 - sin^3), which tends to cos at grazing angles.
    float grazing = cosine < 1e-3 ? cosine : (2.0 / 3.0) * sine / cosine * (1.0 - sine * sine * sine);
    return sine * (acos(clamp(cosine, 0.0, 1.0)) - 2.0 / 3.0 - sine * cosine) + grazing;
}

// BSDF over that of a smooth surface of the same color; v is on the normal's side.
vec3 rough_diffuse_factor(uint packed_roughness, vec3 n, vec3 v, vec3 l) {
    bool behind = dot(n, l) < 0.0;
    if (packed_roughness == 0u || (behind && (packed_roughness & ROUGH_BEHIND) == 0u)) return vec3(1.0);
    if (behind) l = reflect(l, n);
    vec4 parts = unpackUnorm4x8(packed_roughness);
    float nv = max(dot(n, v), 0.0), nl = max(dot(n, l), 0.0);
    float a = 1.0 / (1.0 + parts.w * (0.5 - 2.0 / (3.0 * PI))), b = a * parts.w / PI;
    float t = dot(l, v) - nl * nv;
    if (t > 0.0) t /= max(max(nl, nv), 1e-6);
    float average = a + (2.0 * PI - 5.6) / 3.0 * b;
    float missing_v = 1.0 - a - b * fujii_integral(nv), missing_l = 1.0 - a - b * fujii_integral(nl);
    // Squared as in Cycles, times the color of the smooth surface.
    vec3 multiple = parts.rgb * parts.rgb * average / (1.0 - parts.rgb * (1.0 - average))
                    * (missing_v * missing_l / (1.0 - average));
    return a + PI * b * t + multiple;
}

// Slopes that a normal map hints at shadow diffuse light (Estevez, Lecocq and Stein 2019); smooth_normal: without the
// map. As in Cycles nothing comes from where only one of both normals has it in front, with a map that does not turn
// the normal to the surface's other side.
float bump_shadowing(vec3 smooth_normal, vec3 normal, vec3 l) {
    float part = dot(smooth_normal, normal), side = dot(smooth_normal, l), light = max(abs(side), 1e-6);
    if (part * side * dot(normal, l) < 0.0) return 0.0;
    float alpha2 = min(0.125 * (1.0 / max(part * part, 1e-6) - 1.0), 1.0);
    return 2.0 / (1.0 + sqrt(1.0 + alpha2 * max(1.0 / (light * light) - 1.0, 0.0)));
}
