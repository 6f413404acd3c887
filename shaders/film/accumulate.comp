#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: CLAMPS_LIGHT=1
// UpdatePPMParams: the iteration's estimate enters the running mean of each pixel.

layout(local_size_x = 64) in;

#include <FilmParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
uniform Parameters { FilmParameters parameters; };
#include "density_estimation/splat_sums/read.glsl"
#include "common/clamping.glsl"
#include "common/luminance.glsl"
readonly buffer Radiances;
buffer Film;
buffer PhotonLight;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec4 radiance = radiances[index],
         photons = vec4(clamped_light(read_sum(index, false) * parameters.quantum, 1u), 0.0);
    vec4 estimate = radiance + photons;
    uint pixel = parameters.first_pixel + index;
    vec4 mean = iteration.number_in_film == 1u ? vec4(0.0) : film[pixel];
    film[pixel] = mean + (estimate - mean) / float(iteration.number_in_film);
    if (parameters.is_filtered == 0u) return;
    photons.a = luminance(radiance.rgb) * luminance(radiance.rgb);
    mean = iteration.number_in_film == 1u ? vec4(0.0) : photon_light[pixel];
    photon_light[pixel] = mean + (photons - mean) / float(iteration.number_in_film);
}
