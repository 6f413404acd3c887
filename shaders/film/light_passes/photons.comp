#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What importons took of photons, for the passes of light.

layout(local_size_x = 64) in;

#include <LightPassParameters>
#include "common/invocation.glsl"
uniform Parameters { LightPassParameters parameters; };
#include "film/light_passes/light_passes.glsl"
readonly buffer LightSums;
#include "film/light_passes/read_light_sum.glsl"

vec3 light_of(uint pixel, uint sum) { return read_light_sum(pixel, sum, parameters.light_sums) * parameters.quantum; }

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    if (parameters.caustics != 0u) add_to_pass(PASS_CAUSTICS, index, light_of(index, CAUSTICS_SUM));
    if (parameters.scattered == 0u) return;
    for (uint scatter = SCATTER_DIFFUSE; scatter <= SCATTER_TRANSMISSION; ++scatter) {
        add_scattered_light(scatter, false, index, light_of(index, scattered_sum(scatter, false)));
        add_scattered_light(scatter, true, index, light_of(index, scattered_sum(scatter, true)));
    }
    if ((parameters.light_sums & LIGHT_SUMS_VOLUME) == 0u) return;
    add_volume_light(false, index, light_of(index, volume_sum(false)));
    add_volume_light(true, index, light_of(index, volume_sum(true)));
}
