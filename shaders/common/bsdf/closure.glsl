// SPDX-License-Identifier: GPL-3.0-or-later
#include <Closure>
#include "common/bsdf/microfacet.glsl"

const int CLOSURE_LOBES = 3;
const uint CLOSURE_BACKFACING = 1u;

MicrofacetLobe closure_lobe(Closure closure, int index) {
    if (index == 0)
        return MicrofacetLobe(closure.lobe0_weight, closure.lobe0_kind, closure.lobe0_f0, closure.lobe0_alpha, closure.lobe_ior.x);
    if (index == 1)
        return MicrofacetLobe(closure.lobe1_weight, closure.lobe1_kind, closure.lobe1_f0, closure.lobe1_alpha, closure.lobe_ior.y);
    return MicrofacetLobe(closure.lobe2_weight, closure.lobe2_kind, closure.lobe2_f0, closure.lobe2_alpha, closure.lobe_ior.z);
}

bool closure_hit(Closure closure) { return closure.triangle != NO_TRIANGLE; }

// Lobes above the cut-off store photons; the others are traced on. alpha is roughness squared.
bool lobe_stores(MicrofacetLobe lobe, float specular_alpha) { return lobe.kind != LOBE_NONE && lobe.alpha > specular_alpha; }
bool lobe_is_specular(MicrofacetLobe lobe, float specular_alpha) { return lobe.kind != LOBE_NONE && lobe.alpha <= specular_alpha; }

// Smoother lobes cannot be evaluated towards a light, only followed.
const float SMOOTHEST_LIT = 1e-4;

// How a camera path goes on: the shares of the transparent part and of the three lobes, where they are
// specular; or, stored, of the diffuse part and of the lobes that store photons, by which a path that gathers
// goes on once.
vec4 camera_path_shares(Closure closure, vec3 throughput, float cosine, float specular_alpha, bool stored) {
    vec4 shares = vec4(largest(throughput * (stored ? closure.diffuse : closure.transparent)), 0.0, 0.0, 0.0);
    for (int k = 0; k < CLOSURE_LOBES; ++k) {
        MicrofacetLobe lobe = closure_lobe(closure, k);
        if (stored ? lobe_stores(lobe, specular_alpha) : lobe_is_specular(lobe, specular_alpha))
            shares[1 + k] = largest(throughput * lobe_albedo(lobe, cosine));
    }
    return shares;
}

float sum(vec4 shares) { return shares.x + shares.y + shares.z + shares.w; }

// Roulette sets in once the path's throughput has fallen; total: of all shares by which it may go on.
float path_survival(float total) { return min(1.0, 4.0 * total); }

// Probability of choosing lobe k, survival included.
float lobe_probability(vec4 shares, float total, int k) {
    return shares[1 + k] * path_survival(total) / max(total, 1e-20);
}
