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
