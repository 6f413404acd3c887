// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a closure that scatter photons, and the BSDF of each: the fraction of light from one direction that it
// scatters to a viewer in another.

#include <AdjointQuery>
#include "common/bsdf/stored_lobes.glsl"

// PART_NONE: the BSDF does not depend on the side that it is evaluated from.
const uint PART_NONE = 0u, PART_DIFFUSE = 1u, PART_TRANSLUCENT = 2u, PART_TRANSPARENT = 3u, PART_REFLECTING = 4u,
           PART_TRANSMITTING = 5u, PART_SHARP_REFLECTING = 6u, PART_SHARP_TRANSMITTING = 7u, PART_TOON = 8u,
           PART_HAIR = 9u, PART_STRAND = 10u;

// Lobes up to this alpha scatter light in one direction: rounding leaves no density of them that could be compared.
const float MAX_SHARP_ALPHA = 1e-3;

uint lobe_part(MicrofacetLobe lobe, bool transmitted) {
#ifdef HAIR_LOBES
    if (lobe_is_hair(lobe.kind)) return hair_has_no_side(lobe) ? PART_STRAND : PART_HAIR;
#endif
    if (lobe_is_toon(lobe.kind)) return PART_TOON;
    if (lobe.alpha <= MAX_SHARP_ALPHA) return transmitted ? PART_SHARP_TRANSMITTING : PART_SHARP_REFLECTING;
    return transmitted ? PART_TRANSMITTING : PART_REFLECTING;
}

// A sharp lobe, whose microfacets have the normal that links both directions.
vec3 sharp_bsdf(MicrofacetLobe lobe, bool transmitted, vec3 viewer, vec3 light) {
    vec3 h = transmitted ? lobe.ior * light + viewer : light + viewer;
    float size = length(h), cosine = size > 1e-4 ? abs(dot(viewer, h)) / size : 1.0;
    FacetFresnel fresnel = facet_fresnel(lobe, cosine);
    return transmitted ? fresnel.transmittance : lobe.weight * fresnel.reflectance;
}

// The sum of all lobes of a part, since any of them may have scattered the photon. ior: of a sharp refraction. From the
// other side, the BSDF of a refraction is divided by the squared index: each side is divided by its root.
vec3 lobes_bsdf(uint path, Closure closure, uint part, float ior, vec3 viewer, vec3 light) {
    bool transmitted = part == PART_TRANSMITTING || part == PART_SHARP_TRANSMITTING;
    vec3 bsdf = vec3(0.0);
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(path, k);
        if (lobe.kind == LOBE_NONE || lobe_part(lobe, transmitted) != part) continue;
        // Where viewers are makes no other difference.
        if (part == PART_TOON || part == PART_STRAND) bsdf += lobe.weight;
#ifdef HAIR_LOBES
        else if (part == PART_HAIR) {
            vec3 n = lobe_normal(lobe);
            bsdf += hair_carried(lobe, n, viewer, light) / max(abs(dot(n, light)), 1e-6);
        }
#endif
        else if (part <= PART_TRANSMITTING)
            bsdf += evaluate_lobe(lobe, lobe_normal(lobe), viewer, light)
                    * (lobe_shadowing(lobe, closure.shading_normal, light) * (transmitted ? 1.0 / lobe.ior : 1.0));
        else if (!transmitted || abs(lobe.ior - ior) <= 1e-3 * ior)
            bsdf += sharp_bsdf(lobe, transmitted, viewer, light);
    }
    return bsdf;
}

// The diffuse or translucent part, from its own side of the surface: normal faces the viewer's side.
vec3 diffuse_bsdf(Closure closure, uint part, vec3 normal, vec3 viewer, vec3 light) {
    return (part == PART_DIFFUSE ? closure.diffuse : closure.translucent)
           * diffuse_factor(closure, normal, viewer, light, part == PART_DIFFUSE);
}

// Any part; the closure is that of the viewer's side.
vec3 part_bsdf(uint path, Closure closure, uint part, float ior, vec3 viewer, vec3 light) {
    if (part == PART_TRANSPARENT) return closure.transparent;
    if (part >= PART_REFLECTING) return lobes_bsdf(path, closure, part, ior, viewer, light);
    return diffuse_bsdf(closure, part, unpack_unit_vector(closure.diffuse_normal), viewer, light);
}
