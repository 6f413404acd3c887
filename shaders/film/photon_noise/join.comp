#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Adds to the samples of pixels the light of photons with random signs that their final gather brings.

layout(local_size_x = 64) in;

#include <PhotonNoiseParameters>
#include "common/invocation.glsl"
#include "common/luminance.glsl"
uniform Parameters { PhotonNoiseParameters parameters; };
readonly buffer Radiances;
buffer NoiseSamples;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uvec2 pixel = parameters.step * uvec2(index % parameters.columns, index / parameters.columns);
    noise_samples[index].w = luminance(radiances[(parameters.first_row + pixel.y) * parameters.width + pixel.x].rgb);
}
