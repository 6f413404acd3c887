#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Adds to the passes the radiance that pixels reuse from their own final gather and those of their neighbors, by part.

layout(local_size_x = 64) in;

#include <LightPassParameters>
#include <FinalGather>
#include <GatherParts>
#include "common/invocation.glsl"
uniform Parameters { LightPassParameters parameters; };
#include "film/light_passes/light_passes.glsl"
readonly buffer FinalGatherOrigins;
readonly buffer Importons;
readonly buffer Radiances;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count || final_gather_origins[index].reuse_radius == NO_FINAL_GATHER) return;
    uint history = departing_history(importons[index].history), first = first_scatter(history);
    vec3 light = radiances[index].rgb;
    if (parameters.part == GATHER_PART_CAUSTICS) add_to_pass(PASS_CAUSTICS, index, light);
    else if (is_scattered_by_medium(history)) {
        if (parameters.part == GATHER_PART_ALL) add_volume_light(true, index, light);
    } else if (parameters.part == GATHER_PART_ALL) add_scattered_light(first, true, index, light);
    else {
        add_scattered_light(first, false, index, light);
        add_scattered_light(first, true, index, -light);
    }
}
