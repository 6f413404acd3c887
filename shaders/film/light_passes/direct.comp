#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What shadow rays bring, for the passes of light, from surfaces or from media. At the ends of gathering rays only
// caustics are of interest here.

layout(local_size_x = 64) in;

#include <LightPassParameters>
#include "common/active_paths.glsl"
uniform Parameters { LightPassParameters parameters; };
#include "film/light_passes/light_passes.glsl"
readonly buffer Visibility;
readonly buffer Contributions;
readonly buffer LightSplits;
readonly buffer Importons;
buffer GatheredCaustics;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    if (visibility[index] == 0u) return;
    vec4 contribution = contributions[index];
    vec3 light = contribution.rgb, glossy = light_splits[index].glossy, transmission = light_splits[index].transmission;
    uint history = parameters.segment == 0u ? 0u : departing_history(importons[index].history);
    if (contribution.w > 0.0) {
        if (parameters.caustics == 0u) return;
        bool caustic = (history & HISTORY_CAUSTIC) != 0u, after_diffuse = (history & HISTORY_DIFFUSE) != 0u;
        gathered_caustics[index].rgb += light
                                        * (caustic         ? vec3(1.0)
                                           : after_diffuse ? glossy + transmission
                                                           : vec3(0.0));
    } else if (parameters.scattered == 0u) return;
    else if (first_scatter(history) != SCATTER_NONE) add_scattered_light(first_scatter(history), true, index, light);
    else if (parameters.in_media != 0u) add_volume_light(is_scattered_by_medium(history), index, light);
    else {
        add_scattered_light(SCATTER_DIFFUSE, false, index, light * (1.0 - glossy - transmission));
        add_scattered_light(SCATTER_GLOSSY, false, index, light * glossy);
        add_scattered_light(SCATTER_TRANSMISSION, false, index, light * transmission);
    }
}
