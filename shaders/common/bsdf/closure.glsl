// SPDX-License-Identifier: GPL-3.0-or-later
#include <Closure>
#include <ClosureFlags>
#include <ClosureLobes>
#include <Terminators>
#include <Dispersion>
#include "common/bsdf/microfacet.glsl"

const ClosureLobe EMPTY_LOBE = ClosureLobe(vec3(0.0), LOBE_NONE, vec3(0.0), 0.0, 1.0, 0u, ISOTROPIC);

Closure empty_closure() {
    vec3 none = vec3(0.0);
    return Closure(none, NO_TRIANGLE, none, 0u, none, 0u, none, 0u, none, 0u, 0.0, 0u, 0u, 0.0,
                   ClosureLobe[CLOSURE_LOBES](EMPTY_LOBE, EMPTY_LOBE, EMPTY_LOBE));
}

// How many lobes a closure has. Loops go so far and no further, which also keeps drivers without calls from having the
// code of a lobe three times.
int closure_lobes(Closure closure) { return int((closure.flags >> LOBE_COUNT_SHIFT) & 3u); }

MicrofacetLobe unpacked_lobe(ClosureLobe lobe) {
    return MicrofacetLobe(lobe.weight, unpack_kind(lobe.kind), lobe.f0, lobe.alpha, unpack_tint(lobe.kind), lobe.ior,
                          lobe.normal, lobe.anisotropy);
}

ClosureLobe packed_lobe(MicrofacetLobe lobe) {
    return ClosureLobe(lobe.weight, pack_kind(lobe.kind, lobe.tint), lobe.f0, lobe.alpha, lobe.ior, lobe.normal,
                       lobe.anisotropy);
}

// Fraction of the background that the surface cuts out of the picture.
float closure_holdout(Closure closure) { return unpackUnorm2x16(closure.flags).y; }

float lobe_cosine(MicrofacetLobe lobe, vec3 wo) { return clamp(dot(lobe_normal(lobe), wo), 0.0, 1.0); }

bool closure_backfacing(Closure closure) { return (closure.flags & CLOSURE_BACKFACING) != 0u; }

bool closure_hit(Closure closure) { return closure.triangle != NO_TRIANGLE; }

// Smoother lobes cannot be evaluated toward a light, only followed.
const float MIN_MIS_ALPHA = 1e-4;

// Lobes above the cut-off store photons; the others are traced on. alpha is roughness squared. Fibers are too thin to
// store any.
bool lobe_stores(MicrofacetLobe lobe, float specular_alpha) {
    return lobe.kind != LOBE_NONE && lobe.alpha > specular_alpha && !lobe_is_hair(lobe.kind);
}
bool lobe_is_specular(MicrofacetLobe lobe, float specular_alpha) {
    return lobe.kind != LOBE_NONE && (lobe.alpha <= specular_alpha || lobe_is_hair(lobe.kind));
}

// Whether the weight of what a lobe scatters this way holds the color of a path's wavelength. From within, what is
// reflected does, too: total reflection begins at another angle for each wavelength.
bool is_dispersed(MicrofacetLobe lobe, bool transmitted) {
    return lobe.kind >= LOBE_GLASS && lobe.kind <= LOBE_COATED_GLASS && (transmitted || lobe.ior < 1.0);
}

// Of a path from there on.
uint dispersed_flag(Closure closure, MicrofacetLobe lobe, bool transmitted) {
    return (closure.flags & CLOSURE_DISPERSES) != 0u && is_dispersed(lobe, transmitted) ? PATH_DISPERSED : 0u;
}

// BSDF of the diffuse and translucent parts over that of smooth ones without a normal map; normal is unpacked. As in
// Cycles a map's slopes shadow light that passes only where shadow rays bring it.
vec3 diffuse_factor(Closure closure, vec3 normal, vec3 wo, vec3 wi, bool shadows) {
    vec3 factor = rough_diffuse_factor(closure.diffuse_roughness, normal, wo, wi);
    if (shadows) factor *= bump_shadowing(unpack_unit_vector(closure.shading_normal), normal, wi);
    return factor;
}

// Diffuse and translucent BSDF times cosine. front: wi is on the geometric normal's side.
vec3 diffuse_scattered(Closure closure, vec3 wo, vec3 wi, bool front) {
    vec3 normal = unpack_unit_vector(closure.diffuse_normal);
    float cosine = dot(normal, wi);
    if ((cosine > 0.0) != front) return vec3(0.0);
    return (front ? closure.diffuse : closure.translucent) * diffuse_factor(closure, normal, wo, wi, true)
           * (abs(cosine) / PI);
}

// By what side light that shadow rays bring counts for a closure. As in Cycles that is the shading normal's, so that no
// faces show on smooth surfaces; sampled directions have to be on the geometric normal's side too.
vec3 lit_normal(Closure closure) { return unpack_unit_vector(closure.shading_normal); }

// What a shading offset of the shadow terminator leaves of light: its angle to the normal is stretched.
float terminator_factor(uint closure_flags, vec3 normal, vec3 wi) {
    uint steps = (closure_flags >> TERMINATOR_SHIFT) & TERMINATOR_STEPS;
    float cosine = dot(normal, wi);
    if (steps == 0u || cosine < 0.0) return 1.0;
    float offset = float(steps) / float(TERMINATOR_STEPS);
    return max(cos(acos(min(cosine, 1.0)) / (1.0 - 0.5 * offset)), 0.0) / max(cosine, 1e-6);
}
