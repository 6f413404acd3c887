// SPDX-License-Identifier: GPL-3.0-or-later
// The lobes of a path's closure, fetched one by one where they are asked for: processors have no registers for all.
// The includer declares before the block Closures.

#include "common/bsdf/closure.glsl"

MicrofacetLobe stored_lobe(uint path, int k) { return unpacked_lobe(closures[path].lobes[k]); }

// is_seen: by the camera.
LobeSelection path_shares(uint path, Closure closure, vec3 throughput, vec3 viewer, float specular_alpha, bool gathers,
                          bool is_seen) {
    LobeSelection shares = LobeSelection(
        vec4(largest(throughput * closure.transparent), 0.0, 0.0, 0.0),
        vec4(largest(throughput * closure.diffuse) + largest(throughput * closure.translucent), 0.0, 0.0, 0.0), 0.0,
        1.0);
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(path, k);
        float share = largest(throughput * lobe_albedo(lobe, lobe_cosine(lobe, viewer)));
        if (lobe_is_specular(lobe, specular_alpha)) shares.specular[1 + k] = share;
        else if (lobe_stores(lobe, specular_alpha)) shares.stored[1 + k] = share;
    }
    shares.total = sum(shares.specular) + (gathers ? sum(shares.stored) : 0.0);
    shares.survival = path_survival(shares.total, is_seen);
    return shares;
}

// Whether light from behind the surface is scattered to where it is seen from.
bool lit_from_behind(uint path, Closure closure) {
    bool transmits = largest(closure.translucent) > 0.0;
    for (int k = 0; k < closure_lobes(closure); ++k) transmits = transmits || lobe_transmits(stored_lobe(path, k).kind);
    return transmits;
}
