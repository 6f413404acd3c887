#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// UpdatePPMParams: the iteration's estimate enters the running mean of each pixel.

layout(local_size_x = 64) in;

#include <FilmParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { FilmParameters parameters; };
layout(binding = 0) uniform sampler2D direct_splats;
layout(std430, binding = 0) readonly buffer Radiances { vec4 radiances[]; };
layout(std430, binding = 1) readonly buffer Gathered { uint gathered_bits[]; };
layout(std430, binding = 2) buffer Film { vec4 film[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec3 gathered = uintBitsToFloat(uvec3(gathered_bits[3u * index], gathered_bits[3u * index + 1u], gathered_bits[3u * index + 2u]));
    vec3 splatted = texelFetch(direct_splats, ivec2(index % parameters.width, index / parameters.width), 0).rgb;
    vec4 estimate = radiances[index] + vec4(gathered + splatted, 0.0);
    uint pixel = parameters.first_pixel + index;
    vec4 mean = parameters.iteration == 1u ? vec4(0.0) : film[pixel];
    film[pixel] = mean + (estimate - mean) / float(parameters.iteration);
}
