#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps for some pixels the light without photons, all light, and the light of photons with random signs. The photons
// with their signs then replace the radiance along the rays of the final gather, which neighboring pixels reuse.

layout(local_size_x = 64) in;

#include <PhotonNoiseParameters>
#include "common/invocation.glsl"
#include "common/luminance.glsl"
uniform Parameters { PhotonNoiseParameters parameters; };
#include "density_estimation/splat_sums/read.glsl"
buffer Radiances;
buffer GatherRadiances;
readonly buffer PhotonCounts;
writeonly buffer NoiseSamples;

float read_signed(uint place) {
    uvec2 words = uvec2(photon_counts[place], photon_counts[place + 1u]);
    return quanta_of(uvec3(words.x), uvec3(words.y)).x * parameters.quantum;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    float rest = luminance(radiances[index].rgb);
    float all = rest + luminance(read_sum(index, false)) * parameters.quantum;
    uvec2 pixel = uvec2(index % parameters.width, index / parameters.width);
    if (pixel.y >= parameters.first_row && (pixel.y - parameters.first_row) % parameters.step == 0u
        && pixel.x % parameters.step == 0u)
        noise_samples[(pixel.y - parameters.first_row) / parameters.step * parameters.columns
                      + pixel.x / parameters.step] = vec4(rest, all, read_signed(signed_place(index, false)), 0.0);
    radiances[index].rgb = vec3(0.0);
    if (parameters.gathers != 0u) gather_radiances[index].rgb = vec3(read_signed(signed_place(index, true)));
}
