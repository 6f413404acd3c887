// SPDX-License-Identifier: GPL-3.0-or-later
#include <Closure>
#include <Terminators>
#include "common/bsdf/microfacet.glsl"

const int CLOSURE_LOBES = 3;
const uint CLOSURE_BACKFACING = 1u, CLOSURE_SHADOWLESS = 2u, CLOSURE_CATCHES_SHADOWS = 4u,
           CLOSURE_KEEPS_LIGHT = 8u,  // photons light it, but it sends none on
           CLOSURE_CROWDED = 16u;     // one part, chosen by chance, stands for others
const uint LOBE_COUNT_SHIFT = 8u;  // where in the flags the number of lobes stands

Closure empty_closure() {
    vec3 none = vec3(0.0);
    return Closure(none, NO_TRIANGLE, none, 0u, none, 0u, none, 0u, none, 0u,
                   none, LOBE_NONE, none, 0.0, none, LOBE_NONE, none, 0.0, none, LOBE_NONE, none, 0.0,
                   vec3(1.0), 0.0, uvec3(0u), 0u, uvec3(ISOTROPIC), 0u);
}

// How many lobes a closure has. Loops go so far and no further, which also keeps drivers without calls from having the
// code of a lobe three times.
int closure_lobes(Closure closure) { return int((closure.flags >> LOBE_COUNT_SHIFT) & 3u); }

MicrofacetLobe unpacked_lobe(vec3 weight, uint kind, vec3 f0, float alpha, float ior, uint normal, uint anisotropy) {
    return MicrofacetLobe(weight, unpack_kind(kind), f0, alpha, unpack_tint(kind), ior, normal, anisotropy);
}

MicrofacetLobe closure_lobe(Closure c, int index) {
    if (index == 0)
        return unpacked_lobe(c.lobe0_weight, c.lobe0_kind, c.lobe0_f0, c.lobe0_alpha, c.lobe_ior.x, c.lobe_normals.x,
                             c.lobe_anisotropies.x);
    if (index == 1)
        return unpacked_lobe(c.lobe1_weight, c.lobe1_kind, c.lobe1_f0, c.lobe1_alpha, c.lobe_ior.y, c.lobe_normals.y,
                             c.lobe_anisotropies.y);
    return unpacked_lobe(c.lobe2_weight, c.lobe2_kind, c.lobe2_f0, c.lobe2_alpha, c.lobe_ior.z, c.lobe_normals.z,
                         c.lobe_anisotropies.z);
}

void set_closure_lobe(inout Closure c, int index, MicrofacetLobe lobe) {
    uint kind = pack_kind(lobe.kind, lobe.tint);
    if (index == 0) {
        c.lobe0_weight = lobe.weight;
        c.lobe0_kind = kind;
        c.lobe0_f0 = lobe.f0;
        c.lobe0_alpha = lobe.alpha;
        c.lobe_ior.x = lobe.ior;
        c.lobe_normals.x = lobe.normal;
        c.lobe_anisotropies.x = lobe.anisotropy;
    } else if (index == 1) {
        c.lobe1_weight = lobe.weight;
        c.lobe1_kind = kind;
        c.lobe1_f0 = lobe.f0;
        c.lobe1_alpha = lobe.alpha;
        c.lobe_ior.y = lobe.ior;
        c.lobe_normals.y = lobe.normal;
        c.lobe_anisotropies.y = lobe.anisotropy;
    } else {
        c.lobe2_weight = lobe.weight;
        c.lobe2_kind = kind;
        c.lobe2_f0 = lobe.f0;
        c.lobe2_alpha = lobe.alpha;
        c.lobe_ior.z = lobe.ior;
        c.lobe_normals.z = lobe.normal;
        c.lobe_anisotropies.z = lobe.anisotropy;
    }
}

// Share of the background that the surface cuts out of the picture.
float closure_holdout(Closure closure) { return unpackUnorm2x16(closure.flags).y; }

float lobe_cosine(MicrofacetLobe lobe, vec3 wo) { return clamp(dot(lobe_normal(lobe), wo), 0.0, 1.0); }

bool closure_hit(Closure closure) { return closure.triangle != NO_TRIANGLE; }

// Lobes above the cut-off store photons; the others are traced on. alpha is roughness squared.
bool lobe_stores(MicrofacetLobe lobe, float specular_alpha) {
    return lobe.kind != LOBE_NONE && lobe.alpha > specular_alpha;
}
bool lobe_is_specular(MicrofacetLobe lobe, float specular_alpha) {
    return lobe.kind != LOBE_NONE && lobe.alpha <= specular_alpha;
}

// Smoother lobes cannot be evaluated toward a light, only followed.
const float SMOOTHEST_LIT = 1e-4;

// BSDF of the diffuse and translucent parts over that of smooth ones without a normal map; normal is unpacked.
vec3 diffuse_factor(Closure closure, vec3 normal, vec3 wo, vec3 wi) {
    return bump_shadowing(unpack_unit_vector(closure.shading_normal), normal, wi)
        * rough_diffuse_factor(closure.diffuse_roughness, normal, wo, wi);
}

// Diffuse and translucent BSDF times cosine. front: wi is on the geometric normal's side.
vec3 diffuse_scattered(Closure closure, vec3 wo, vec3 wi, bool front) {
    vec3 normal = unpack_unit_vector(closure.diffuse_normal);
    float cosine = dot(normal, wi);
    if ((cosine > 0.0) != front) return vec3(0.0);
    return (front ? closure.diffuse : closure.translucent) * diffuse_factor(closure, normal, wo, wi)
           * (abs(cosine) / PI);
}

// By what side light counts for a closure, toward the viewer.
vec3 lit_normal(Closure closure) {
    return unpack_unit_vector((closure.flags & CLOSURE_CURVED) != 0u ? closure.shading_normal
                              : closure.geometric_normal);
}

// What a shading offset of the shadow terminator leaves of light: its angle to the normal is stretched.
float terminator_factor(uint closure_flags, vec3 normal, vec3 wi) {
    uint steps = (closure_flags >> TERMINATOR_SHIFT) & TERMINATOR_STEPS;
    float cosine = dot(normal, wi);
    if (steps == 0u || cosine < 0.0) return 1.0;
    float offset = float(steps) / float(TERMINATOR_STEPS);
    return max(cos(acos(min(cosine, 1.0)) / (1.0 - 0.5 * offset)), 0.0) / max(cosine, 1e-6);
}

float sum(vec4 shares) { return shares.x + shares.y + shares.z + shares.w; }

// How a camera path may go on: shares of the transparent part and of the three lobes, where they are specular; and of
// the diffuse and translucent parts together and of the lobes that store photons, by which a path that gathers goes on
// once. total: of those by which it may go on.
struct PathShares { vec4 specular; vec4 stored; float total; };

PathShares path_shares(Closure closure, vec3 throughput, vec3 viewer, float specular_alpha, bool gathers) {
    PathShares shares = PathShares(vec4(largest(throughput * closure.transparent), 0.0, 0.0, 0.0),
                                   vec4(largest(throughput * closure.diffuse)
                                        + largest(throughput * closure.translucent), 0.0, 0.0, 0.0), 0.0);
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = closure_lobe(closure, k);
        float share = largest(throughput * lobe_albedo(lobe, lobe_cosine(lobe, viewer)));
        if (lobe_is_specular(lobe, specular_alpha)) shares.specular[1 + k] = share;
        else if (lobe_stores(lobe, specular_alpha)) shares.stored[1 + k] = share;
    }
    shares.total = sum(shares.specular) + (gathers ? sum(shares.stored) : 0.0);
    return shares;
}

// Roulette sets in once the path's throughput has fallen; total: of all shares by which it may go on.
float path_survival(float total) { return min(1.0, 4.0 * total); }

// Whether a smooth lobe reflects so seldom that a shadow ray looks for light objects where its reflection leads, since
// paths that go there would find them seldom and then very bright. alpha: up to which lobes are smooth.
bool looks_for_reflected_lights(MicrofacetLobe lobe, vec4 shares, float total, int k, vec3 viewer, float alpha) {
    if (!lobe_is_specular(lobe, alpha) || lobe_is_sheen(lobe.kind) || !(shares[1 + k] > 0.0)) return false;
    float reflected = facet_shares(lobe, lobe_cosine(lobe, viewer)).reflected;
    return reflected > 0.0 && shares[1 + k] * reflected < 0.5 * total;
}

// Probability of choosing lobe k, survival included.
float lobe_probability(vec4 shares, float total, int k) {
    return shares[1 + k] * path_survival(total) / max(total, 1e-20);
}
