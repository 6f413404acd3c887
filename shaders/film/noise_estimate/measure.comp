#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The noise of blocks of pixels, in Cycles' unit: bright pixels may be noisier, as the eye sees less of it there.

layout(local_size_x = 64) in;

#include <NoiseParameters>
#include <NoiseBlocks>
#include "common/finite.glsl"
#include "common/invocation.glsl"
uniform Parameters { NoiseParameters parameters; };
readonly buffer Film;
readonly buffer HalfMeans;
writeonly buffer Noises { float noises[]; };

const float EPSILON = 1e-4;

// Sum of the channels.
float total(vec3 color) { return color.r + color.g + color.b; }

float noise_of(uint pixel) {
    vec3 mean = film[pixel].rgb, half_mean;
    for (uint channel = 0u; channel < 3u; channel++) half_mean[channel] = half_means[3u * pixel + channel];
    float intensity = parameters.exposure * abs(total(mean));
    float difference = parameters.exposure * parameters.balance * total(abs(mean - half_mean));
    return difference / (EPSILON + (intensity < 1.0 ? sqrt(intensity) : intensity));
}

void main() {
    uint block = invocation_index();
    if (block >= parameters.count) return;
    uvec2 low = NOISE_BLOCK * uvec2(block % parameters.columns, block / parameters.columns);
    uvec2 high = min(low + NOISE_BLOCK, uvec2(parameters.width, parameters.height));
    float sum = 0.0;
    for (uint y = low.y; y < high.y; y++) {
        for (uint x = low.x; x < high.x; x++) {
            float noise = noise_of(y * parameters.width + x);
            // What is not finite stays so however many iterations come.
            if (is_finite(vec3(noise))) sum += noise;
        }
    }
    noises[block] = sum / float((high.x - low.x) * (high.y - low.y));
}
