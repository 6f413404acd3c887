// SPDX-License-Identifier: GPL-3.0-or-later
#include "density_estimation/splat_sums/light_sums.glsl"
#include "density_estimation/splat_sums/sums.glsl"

// One of a pixel's sums for passes of light, in quanta. Needs light_words[].
vec3 read_light_sum(uint pixel, uint sum, uint sums) {
    uint place = first_light_word(pixel, sum, sums);
    return quanta_of(uvec3(light_words[place], light_words[place + 2u], light_words[place + 4u]),
                     uvec3(light_words[place + 1u], light_words[place + 3u], light_words[place + 5u]));
}
