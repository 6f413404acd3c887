// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers from a node graph may be anything; what they make of light stays finite.

#define ADDS_LOBES
#include "common/finite.glsl"
#include "common/bsdf/closure.glsl"

// Weights beyond the limit would overflow within a path.
const float LARGEST_WEIGHT = 1e3, LARGEST_EMISSION = 1e12;

vec3 usable(vec3 value, float low, float high) {
    return is_finite(value) ? clamp(value, low, high) : vec3(max(low, 0.0));
}

ClosureLobe usable_lobe(ClosureLobe lobe) {
    lobe.weight = usable(lobe.weight, 0.0, LARGEST_WEIGHT);
    // The coefficients of a sheen may be negative.
    lobe.f0 = usable(lobe.f0, -LARGEST_WEIGHT, LARGEST_WEIGHT);
    lobe.alpha = usable(vec3(lobe.alpha), 0.0, 1.0).x;
    lobe.ior = usable(vec3(lobe.ior), 1e-5, 1e5).x;
    return lobe;
}

void make_usable(inout Closure closure) {
    closure.emission = usable(closure.emission, -LARGEST_EMISSION, LARGEST_EMISSION);
    closure.diffuse = usable(closure.diffuse, 0.0, LARGEST_WEIGHT);
    closure.translucent = usable(closure.translucent, 0.0, LARGEST_WEIGHT);
    closure.transparent = usable(closure.transparent, 0.0, LARGEST_WEIGHT);
    for (int k = 0; k < CLOSURE_LOBES; ++k) {
        closure.lobes[k].weight = usable(closure.lobes[k].weight, 0.0, LARGEST_WEIGHT);
        // The coefficients of a sheen may be negative.
        closure.lobes[k].f0 = usable(closure.lobes[k].f0, -LARGEST_WEIGHT, LARGEST_WEIGHT);
    }
    // All three at once: the least code.
    vec3 alphas = usable(vec3(closure.lobes[0].alpha, closure.lobes[1].alpha, closure.lobes[2].alpha), 0.0, 1.0),
         iors = usable(vec3(closure.lobes[0].ior, closure.lobes[1].ior, closure.lobes[2].ior), 1e-5, 1e5);
    for (int k = 0; k < CLOSURE_LOBES; ++k) {
        closure.lobes[k].alpha = alphas[k];
        closure.lobes[k].ior = iors[k];
    }
}
