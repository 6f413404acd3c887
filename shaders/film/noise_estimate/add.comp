#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// An estimate enters the mean of half of the iterations.

layout(local_size_x = 64) in;

#include <HalfParameters>
#include "common/invocation.glsl"
uniform Parameters { HalfParameters parameters; };
#include "density_estimation/splat_sums/read.glsl"
readonly buffer Radiances;
buffer HalfMeans;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec3 estimate = radiances[index].rgb + read_sum(index, false) * parameters.quantum;
    uint place = 3u * (parameters.first_pixel + index);
    for (uint channel = 0u; channel < 3u; channel++) {
        float mean = parameters.number == 1u ? 0.0 : half_means[place + channel];
        half_means[place + channel] = mean + (estimate[channel] - mean) / float(parameters.number);
    }
}
