#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What the AOV Output nodes of an iteration wrote enters the running means.

layout(local_size_x = 64) in;

#include <AovParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
uniform Parameters { AovParameters parameters; };
readonly buffer AovValues;
buffer FilmAovs { float film_aovs[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    float mean = iteration.number_in_film == 1u ? 0.0 : film_aovs[index];
    film_aovs[index] = mean + (aov_values[index] - mean) / float(iteration.number_in_film);
}
