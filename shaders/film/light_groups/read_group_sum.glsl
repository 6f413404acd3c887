// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/light_groups/group_sums.glsl"
#include "density_estimation/splat_sums/sums.glsl"
readonly buffer GroupSums;

// What a pixel took of the photons of a group, in quanta.
vec3 read_group_sum(uint pixel, uint group, bool final_gather) {
    uint place = first_group_word(pixel, group, final_gather, parameters.groups);
    return quanta_of(uvec3(group_words[place], group_words[place + 2u], group_words[place + 4u]),
                     uvec3(group_words[place + 1u], group_words[place + 3u], group_words[place + 5u]));
}
