#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The light of a group in an iteration enters the running mean of each pixel.

layout(local_size_x = 64) in;

#include <LightGroupParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
uniform Parameters { LightGroupParameters parameters; };
#include "film/light_groups/grouped.glsl"
#include "film/light_groups/read_group_sum.glsl"
readonly buffer Radiances;
buffer GroupValues;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec3 light = grouped_light_of(index, parameters.group, false) + radiances[index].rgb
                 + read_group_sum(index, parameters.group, false) * parameters.quantum;
    uint place = 3u * (parameters.groups * index + parameters.group);
    for (uint channel = 0u; channel < 3u; ++channel) {
        float mean = iteration.number_in_film == 1u ? 0.0 : group_values[place + channel];
        group_values[place + channel] = mean + (light[channel] - mean) / float(iteration.number_in_film);
    }
}
