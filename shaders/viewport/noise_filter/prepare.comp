#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Light over albedo with the variance of its luminance, and what tells surfaces apart. Schied et al., Spatiotemporal
// Variance-Guided Filtering (HPG 2017): of few samples, the variance is that of the pixels around.

layout(local_size_x = 64) in;

#include "viewport/noise_filter/film.glsl"
writeonly buffer Signals;
writeonly buffer Guides;

const uint SAMPLES_THAT_TELL = 4u;
const int REACH = 2;
const float SAME_NORMAL = 0.9, SAME_DEPTH = 0.1;

vec4 guide_of(uint pixel) {
    vec3 normal = pass_values_at(parameters.normal, pixel);
    float depth = pass_values[parameters.depth + pixel], size = length(normal);
    return vec4(size > 0.0 ? normal / size : vec3(0.0), depth);
}

float variance_around(ivec2 pixel, vec4 guide) {
    ivec2 size = ivec2(parameters.width, parameters.pixels / parameters.width);
    float sum = 0.0, squares = 0.0, count = 0.0;
    for (int y = max(pixel.y - REACH, 0); y <= min(pixel.y + REACH, size.y - 1); ++y) {
        for (int x = max(pixel.x - REACH, 0); x <= min(pixel.x + REACH, size.x - 1); ++x) {
            uint other = uint(y * size.x + x);
            vec4 around = guide_of(other);
            if (dot(around.xyz, guide.xyz) < SAME_NORMAL * dot(guide.xyz, guide.xyz)
                || abs(around.w - guide.w) > SAME_DEPTH * guide.w)
                continue;
            float value = luminance(filtered_light(other) / albedo_of(other));
            sum += value;
            squares += value * value;
            count += 1.0;
        }
    }
    return max(squares - sum * sum / max(count, 1.0), 0.0) / max(count - 1.0, 1.0);
}

void main() {
    uint pixel = invocation_index();
    if (pixel >= parameters.pixels) return;
    vec4 guide = guide_of(pixel);
    vec3 albedo = albedo_of(pixel), light = filtered_light(pixel);
    float variance;
    if (parameters.iteration < SAMPLES_THAT_TELL) {
        variance = variance_around(ivec2(pixel % parameters.width, pixel / parameters.width), guide);
    } else {
        float mean = luminance(film[pixel].rgb - photon_light[pixel].rgb), scale = luminance(albedo);
        variance = max(photon_light[pixel].a - mean * mean, 0.0) / float(parameters.iteration - 1u) / (scale * scale);
    }
    signals[pixel] = vec4(light / albedo, min(variance, 1e12));
    guides[pixel] = guide;
}
