// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of quanta to which many threads add at once. The includer declares the members of SUM_PARAMETERS
// (integrator/density_estimation/splat_sums.py).

#include "density_estimation/splat_sums/signs.glsl"
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

void add_radiance_quanta(uint pixel, bool final_gather, vec3 radiance) {
    uint place = first_word(pixel, final_gather);
    add_quanta(place, radiance.r * parameters.quanta);
    add_quanta(place + 2u, radiance.g * parameters.quanta);
    add_quanta(place + 4u, radiance.b * parameters.quanta);
}
