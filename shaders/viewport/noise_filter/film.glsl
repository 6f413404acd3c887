// SPDX-License-Identifier: GPL-3.0-or-later
// What the noise filter takes of a film: light by rays, over the albedo that it is seen by. Photons are spread over
// their radius already, and caustics are theirs: these keep their edges.

#include <NoiseFilterParameters>
#include "common/finite.glsl"
#include "common/invocation.glsl"
#include "common/luminance.glsl"
uniform Parameters { NoiseFilterParameters parameters; };
readonly buffer Film;
readonly buffer PhotonLight;
readonly buffer PassValues;

const vec3 DARKEST_ALBEDO = vec3(0.02);

// Three values of a pass whose values begin at first.
vec3 pass_values_at(uint first, uint pixel) {
    uint place = first + 3u * pixel;
    return vec3(pass_values[place], pass_values[place + 1u], pass_values[place + 2u]);
}

vec3 albedo_of(uint pixel) { return max(pass_values_at(parameters.albedo, pixel), DARKEST_ALBEDO); }

// What is left as it is: photons, and lights that are seen.
vec3 kept_light(uint pixel) {
    return photon_light[pixel].rgb + pass_values_at(parameters.emission, pixel)
           + pass_values_at(parameters.environment, pixel);
}

// Black where the film holds no number.
vec3 filtered_light(uint pixel) {
    vec3 light = film[pixel].rgb;
    return is_finite(light) ? light - kept_light(pixel) : vec3(0.0);
}
