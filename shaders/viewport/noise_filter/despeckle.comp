#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The filtered light becomes a picture again. A glass or water surface sends each path of few to what it reflects or
// to what is behind it, so that single pixels have nothing of what their neighbors have: of few samples, one that is by
// half darker than nearly all pixels around takes the mean of these.

layout(local_size_x = 64) in;

#include "viewport/noise_filter/film.glsl"
uniform sampler2D signal_image;
writeonly buffer Signals;

const uint AROUND = 8u, DARKER_KEPT = 2u;
// How bright a speckle is over what is around: that of photons is uneven as well.
const float SPECKLE = 0.5;
const uint SAMPLES_WITHOUT_SPECKLES = 16u;

vec3 light_at(ivec2 pixel) {
    uint index = uint(pixel.y) * parameters.width + uint(pixel.x);
    return texelFetch(signal_image, pixel, 0).rgb * albedo_of(index) + kept_light(index);
}

vec3 despeckled(ivec2 pixel, vec3 light) {
    ivec2 last = ivec2(parameters.width, parameters.pixels / parameters.width) - 1;
    float own = luminance(light);
    vec3 brighter = vec3(0.0);
    uint count = 0u;
    for (uint k = 0u; k < AROUND; ++k) {
        uint cell = k < 4u ? k : k + 1u;
        vec3 other = light_at(clamp(pixel + ivec2(cell % 3u, cell / 3u) - 1, ivec2(0), last));
        if (luminance(other) <= own) continue;
        brighter += other;
        count += 1u;
    }
    brighter /= max(float(count), 1.0);
    float around = luminance(brighter);
    // Where light is negative, half as bright is no measure.
    return count + DARKER_KEPT > AROUND && around > 0.0 && own < SPECKLE * around ? brighter : light;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.pixels) return;
    ivec2 pixel = ivec2(index % parameters.width, index / parameters.width);
    vec4 noisy = film[index];
    vec3 light = light_at(pixel);
    if (parameters.iteration < SAMPLES_WITHOUT_SPECKLES) light = despeckled(pixel, light);
    if (!is_finite(noisy.rgb)) noisy.rgb = light;
    signals[index] = vec4(mix(noisy.rgb, light, parameters.strength), noisy.a);
}
