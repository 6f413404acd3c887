// SPDX-License-Identifier: GPL-3.0-or-later
// Light of an iteration by light group, W/(m^2 sr): for each pixel of the band, for each group, what the pixel has got
// but for photons, and what arrives along the ray of its final gather. Needs the member groups of the parameters.
#include <LightGroups>
buffer GroupedLight;

uint grouped_place(uint pixel, uint group, bool final_gather) {
    return 6u * (parameters.groups * pixel + group) + (final_gather ? 3u : 0u);
}

vec3 grouped_light_of(uint pixel, uint group, bool final_gather) {
    uint place = grouped_place(pixel, group, final_gather);
    return vec3(grouped_light[place], grouped_light[place + 1u], grouped_light[place + 2u]);
}

void add_to_group(uint pixel, uint group, bool final_gather, vec3 light) {
    if (group == NO_LIGHT_GROUP) return;
    uint place = grouped_place(pixel, group, final_gather);
    for (uint channel = 0u; channel < 3u; ++channel) grouped_light[place + channel] += light[channel];
}
