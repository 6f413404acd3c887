#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The light that camera paths met in a segment, for the passes of what shines by itself. Denoisers take it as albedo.

layout(local_size_x = 64) in;

#include <PassParameters>
#include "common/living_paths.glsl"
layout(std140, binding = 0) uniform Parameters { PassParameters parameters; };
#include "film/passes.glsl"
layout(std430, binding = 9) readonly buffer Radiances;

void main() {
    uint index = living_path();
    if (index == NO_PATH) return;
    vec4 before = pass_paths[index];
    uint path = floatBitsToUint(before.w), pixel = parameters.first_pixel + index;
    vec3 met = radiances[index].rgb - before.rgb;
    if ((path & PASS_PATH_STRAIGHT) != 0u)
        add_to_pass((path & PASS_PATH_HIT) != 0u ? PASS_EMISSION : PASS_ENVIRONMENT, pixel, met);
    if ((path & PASS_PATH_DENOISED) != 0u) add_to_pass(PASS_DENOISING_ALBEDO, pixel, min(met, 1.0));
}
