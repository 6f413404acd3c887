#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// UpdatePPMParams: the iteration's estimate enters the running mean of each pixel.

layout(local_size_x = 64) in;

#include <FilmParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { FilmParameters parameters; };
layout(std430, binding = 0) readonly buffer Radiances { vec4 radiances[]; };
layout(std430, binding = 1) readonly buffer Gathered { uint gathered_words[]; };
layout(std430, binding = 2) buffer Film { vec4 film[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec3 low = vec3(gathered_words[6u * index], gathered_words[6u * index + 2u], gathered_words[6u * index + 4u]);
    vec3 high = vec3(gathered_words[6u * index + 1u], gathered_words[6u * index + 3u], gathered_words[6u * index + 5u]);
    vec4 estimate = radiances[index] + vec4((high * 4294967296.0 + low) * parameters.quantum, 0.0);
    uint pixel = parameters.first_pixel + index;
    vec4 mean = parameters.iteration == 1u ? vec4(0.0) : film[pixel];
    film[pixel] = mean + (estimate - mean) / float(parameters.iteration);
}
