// SPDX-License-Identifier: GPL-3.0-or-later
// What photons add to the sums for passes of light and for light groups. The includer declares the members
// of SUM_PARAMETERS (integrator/density_estimation/splat_sums.py).

#include "density_estimation/splat_sums/light_sums.glsl"
#include "film/light_groups/group_sums.glsl"
buffer LightSums;
buffer GroupSums;

// Whether a surface or a medium has scattered a photon on its way from the light.
bool is_indirect(uint photon_flags, uint bounce_counts, uint depth) {
#ifdef EMISSIVE_MEDIA
    if (bounces_of(depth) == 0u) return false;  // photons of media begin as if they were indirect
#endif
    return (photon_flags & (PHOTON_SCATTERED_BY_LOBE | PHOTON_INDIRECT)) != 0u || medium_count(bounce_counts) > 0u;
}

void add_light_word(uint place, float quanta) {
    uvec2 added = whole_quanta(quanta);
    if (added.x > 0u && atomicAdd(light_words[place], added.x) > 0xffffffffu - added.x) added.y += 1u;
    if (added.y > 0u) atomicAdd(light_words[place + 1u], added.y);
}

void add_to_light_sum(uint pixel, uint sum, vec3 radiance) {
    if (!(largest(radiance) > 0.0)) return;
    uint place = first_light_word(pixel, sum, parameters.light_sums);
    add_light_word(place, radiance.r * parameters.quanta);
    add_light_word(place + 2u, radiance.g * parameters.quanta);
    add_light_word(place + 4u, radiance.b * parameters.quanta);
}

void add_group_word(uint place, float quanta) {
    uvec2 added = whole_quanta(quanta);
    if (added.x > 0u && atomicAdd(group_words[place], added.x) > 0xffffffffu - added.x) added.y += 1u;
    if (added.y > 0u) atomicAdd(group_words[place + 1u], added.y);
}

void add_to_group_sum(uint pixel, uint group, bool final_gather, vec3 radiance) {
    if (group == NO_LIGHT_GROUP) return;
    uint place = first_group_word(pixel, group, final_gather, parameters.light_groups);
    for (uint channel = 0u; channel < 3u; ++channel)
        add_group_word(place + 2u * channel, radiance[channel] * parameters.quanta);
}
