// SPDX-License-Identifier: GPL-3.0-or-later
// Light that goes below a surface, as closures keep it: in the place of their last lobe, behind those that they count.
// The closure's diffuse part holds it as well, for whoever takes light to leave where it came in.

#include "common/bsdf/closure.glsl"
#include <SubsurfaceMethods>

struct Subsurface {
    vec3 weight;       // of what goes in and comes out, in which the albedo is
    vec3 albedo;       // of light that comes out
    vec3 radius;       // mean free path of each channel, meters
    float anisotropy;  // of the phase function
    float ior;         // with the roughness squared that of the surface where paths go in
    float alpha;
    uint method;
    uint normal;  // packed
};

const Subsurface NO_SUBSURFACE = Subsurface(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 1.4, 1.0, 0u, 0u);

bool has_subsurface(Closure closure) { return (closure.flags & CLOSURE_SUBSURFACE) != 0u; }

uint unit_bits(float value, uint bits) {
    return uint(whole_part(clamp(value, 0.0, 1.0) * float((1u << bits) - 1u) + 0.5));
}
float unit_of_bits(uint word, uint bits) {
    uint most = (1u << bits) - 1u;
    return float(word & most) / float(most);
}

// The anisotropy has fourteen bits behind those of the lobe's kind, then come twelve of alpha, and the method last.
ClosureLobe packed_subsurface(Subsurface part) {
    uint kind = LOBE_NONE | unit_bits(0.5 * part.anisotropy + 0.5, 14u) << 4u | unit_bits(part.alpha, 12u) << 18u
                | part.method << 30u;
    uint albedo = unit_bits(part.albedo.x, 16u) | unit_bits(part.albedo.y, 16u) << 16u;
    return ClosureLobe(part.weight, kind, part.radius, part.albedo.z, part.ior, part.normal, albedo);
}

Subsurface unpacked_subsurface(ClosureLobe lobe) {
    vec3 albedo = vec3(unit_of_bits(lobe.anisotropy, 16u), unit_of_bits(lobe.anisotropy >> 16u, 16u), lobe.alpha);
    return Subsurface(lobe.weight, albedo, lobe.f0, 2.0 * unit_of_bits(lobe.kind >> 4u, 14u) - 1.0, lobe.ior,
                      unit_of_bits(lobe.kind >> 18u, 12u), lobe.kind >> 30u, lobe.normal);
}

// What of the diffuse part leaves where it came in.
vec3 diffuse_beside(Closure closure, Subsurface part) {
    vec3 beside = closure.diffuse - part.weight;
    return mix(beside, vec3(0.0), lessThan(beside, 1e-5 * closure.diffuse));
}
