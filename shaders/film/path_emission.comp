#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Emission at the end of the rays of camera paths, for the passes Emission and Environment or, where a surface has
// scattered the path before, for those of scattered light. Denoisers take it as albedo.

layout(local_size_x = 64) in;

#include <PassParameters>
#include "common/active_paths.glsl"
uniform Parameters { PassParameters parameters; };
#include "film/light_passes/light_passes.glsl"
readonly buffer Importons;
readonly buffer Radiances;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    vec4 before = pass_paths[index];
    uint path = floatBitsToUint(before.w);
    vec3 emitted = radiances[index].rgb - before.rgb;
    if ((path & PASS_PATH_CAMERA_TRANSPARENT) != 0u)
        add_to_pass((path & PASS_PATH_HIT) != 0u ? PASS_EMISSION : PASS_ENVIRONMENT, index, emitted);
    else {
        // What an importon says of how its path came is of the last surface.
        bool hit = (path & PASS_PATH_HIT) != 0u;
        uint history = hit ? arrived_history(importons[index].history) : departing_history(importons[index].history);
        add_scattered_light(first_scatter(history), (history & HISTORY_AGAIN) != 0u, index, emitted);
    }
    if ((path & PASS_PATH_DENOISED) != 0u) add_to_pass(PASS_DENOISING_ALBEDO, index, min(emitted, 1.0));
}
