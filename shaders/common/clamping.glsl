// SPDX-License-Identifier: GPL-3.0-or-later
// Clamping of light that a path brings to its pixel, as in Cycles.
#include "common/iteration.glsl"

// Light of a path that is weighted by its throughput, scaled so that the mean of its channels is at most the limit.
// bounces: of the path from the camera to where it looks for the light; direct light has none.
vec3 clamped_light(vec3 light, uint bounces) {
#ifdef CLAMPS_LIGHT
    float limit = bounces > 0u ? iteration.clamp_indirect : iteration.clamp_direct;
    float mean = (abs(light.r) + abs(light.g) + abs(light.b)) / 3.0;
    if (mean > limit) light *= limit / mean;
#endif
    return light;
}

// Bounces of a path, of this depth, before the ray by which it meets emission: what it meets first is direct light.
uint bounces_before_emission(uint bounces) { return max(bounces, 1u) - 1u; }
