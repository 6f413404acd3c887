// SPDX-License-Identifier: GPL-3.0-or-later

#include "density_estimation/splat_sums/sums.glsl"
readonly buffer SplatSums;

// The sum of a pixel in quanta.
vec3 read_sum(uint pixel, bool final_gather) {
    uint place = first_word(pixel, final_gather);
    return quanta_of(uvec3(sum_words[place], sum_words[place + 2u], sum_words[place + 4u]),
                     uvec3(sum_words[place + 1u], sum_words[place + 3u], sum_words[place + 5u]));
}
