// SPDX-License-Identifier: GPL-3.0-or-later
// The lobes of a path's closure. They are read one at a time where they are needed, because processors have no
// registers for all of them. The includer declares the block Closures before.

#include "common/bsdf/closure.glsl"

MicrofacetLobe stored_lobe(uint path, int k) { return unpacked_lobe(closures[path].lobes[k]); }

// Whether light from behind the surface is scattered to where it is seen from.
bool lit_from_behind(uint path, Closure closure) {
    bool transmits = largest(closure.translucent) > 0.0;
    for (int k = 0; k < closure_lobes(closure); ++k) transmits = transmits || lobe_transmits(stored_lobe(path, k).kind);
    return transmits;
}
