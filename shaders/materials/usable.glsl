// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers from a node graph may be anything; what they make of light stays finite.

#include "common/finite.glsl"
#include "common/bsdf/closure.glsl"

// Weights beyond the limit would overflow within a path.
const float LARGEST_WEIGHT = 1e3, LARGEST_EMISSION = 1e12;

vec3 usable(vec3 value, float low, float high) {
    return is_finite(value) ? clamp(value, low, high) : vec3(max(low, 0.0));
}

void make_usable(inout Closure closure) {
    closure.emission = usable(closure.emission, 0.0, LARGEST_EMISSION);
    closure.diffuse = usable(closure.diffuse, 0.0, LARGEST_WEIGHT);
    closure.translucent = usable(closure.translucent, 0.0, LARGEST_WEIGHT);
    closure.transparent = usable(closure.transparent, 0.0, LARGEST_WEIGHT);
    closure.lobe0_weight = usable(closure.lobe0_weight, 0.0, LARGEST_WEIGHT);
    closure.lobe1_weight = usable(closure.lobe1_weight, 0.0, LARGEST_WEIGHT);
    closure.lobe2_weight = usable(closure.lobe2_weight, 0.0, LARGEST_WEIGHT);
    // The coefficients of a sheen may be negative.
    closure.lobe0_f0 = usable(closure.lobe0_f0, -LARGEST_WEIGHT, LARGEST_WEIGHT);
    closure.lobe1_f0 = usable(closure.lobe1_f0, -LARGEST_WEIGHT, LARGEST_WEIGHT);
    closure.lobe2_f0 = usable(closure.lobe2_f0, -LARGEST_WEIGHT, LARGEST_WEIGHT);
    vec3 alphas = usable(vec3(closure.lobe0_alpha, closure.lobe1_alpha, closure.lobe2_alpha), 0.0, 1.0);
    closure.lobe0_alpha = alphas.x;
    closure.lobe1_alpha = alphas.y;
    closure.lobe2_alpha = alphas.z;
    closure.lobe_ior = usable(closure.lobe_ior, 1e-5, 1e5);
}
