// SPDX-License-Identifier: GPL-3.0-or-later
// A photon beam adds to the sums of a pixel, many threads at once. The includer includes
// density_estimation/splat_sums/signs.glsl before.

#include "density_estimation/splat_sums/add_light.glsl"
buffer SplatSums;
buffer PhotonCounts;

void add_quanta(uint place, float quanta) {
    uvec2 added = whole_quanta(quanta);
    if (added.x > 0u && atomicAdd(sum_words[place], added.x) > 0xffffffffu - added.x) added.y += 1u;
    if (added.y > 0u) atomicAdd(sum_words[place + 1u], added.y);
}

void add_signed_quanta(uint place, float quanta) {
    uvec2 added = whole_quanta(quanta);
    if (added.x > 0u && atomicAdd(photon_counts[place], added.x) > 0xffffffffu - added.x) added.y += 1u;
    if (added.y > 0u) atomicAdd(photon_counts[place + 1u], added.y);
}

// Threads that meet here write the same mark.
void add_beam(uint pixel, PhotonBeam beam, vec3 radiance) {
    if (!(largest(radiance) > 0.0)) return;
    photons[beam.photon].depth = photons[beam.photon].depth | PHOTON_CONTRIBUTED;
    uint place = first_word(pixel, false);
    add_quanta(place, radiance.r * parameters.quanta);
    add_quanta(place + 2u, radiance.g * parameters.quanta);
    add_quanta(place + 4u, radiance.b * parameters.quanta);
    if ((parameters.light_sums & LIGHT_SUMS_GROUPS) != 0u) add_to_group_sum(pixel, beam.light_group, false, radiance);
    if ((parameters.light_sums & LIGHT_SUMS_VOLUME) != 0u)
        add_to_light_sum(pixel, volume_sum(is_indirect(beam.flags, beam.bounce_counts)), radiance);
    if ((parameters.light_sums & LIGHT_SUMS_CAUSTICS) != 0u && (beam.flags & PHOTON_CAUSTIC) != 0u)
        add_to_light_sum(pixel, CAUSTICS_SUM, radiance);
    if (parameters.counting == 0u) return;
    add_signed_quanta(signed_place(pixel, false), photon_sign(beam.path) * luminance(radiance) * parameters.quanta);
}
