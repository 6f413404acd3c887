// SPDX-License-Identifier: GPL-3.0-or-later
// An importon collects for itself what photons add, in a thread that no other thread meets at its sums.
// The includer declares the members of SUM_PARAMETERS (integrator/density_estimation/splat_sums.py).

#include "density_estimation/splat_sums/signs.glsl"
buffer SplatSums;
buffer PhotonCounts;

struct Collected {
    uvec2 red;
    uvec2 green;
    uvec2 blue;
    uint diffused;
    uint caustic;
    uvec2 with_signs;
};

void add_words(inout uvec2 sum, uvec2 added) {
    sum.x += added.x;
    sum.y += added.y + (sum.x < added.x ? 1u : 0u);
}

void collect_splat(inout Collected collected, uint photon, vec3 radiance, bool diffused, uint stands_for) {
    add_words(collected.red, whole_quanta(radiance.r * parameters.quanta));
    add_words(collected.green, whole_quanta(radiance.g * parameters.quanta));
    add_words(collected.blue, whole_quanta(radiance.b * parameters.quanta));
    if (diffused) ++collected.diffused;
    else collected.caustic += stands_for;
    if (parameters.counting == 0u) return;
    float quanta = luminance(radiance) * parameters.quanta;
    add_words(collected.with_signs, whole_quanta(photon_sign(photons[photon].path) * quanta));
}

void write_words(uint place, uvec2 added) {
    uvec2 sum = uvec2(sum_words[place], sum_words[place + 1u]);
    add_words(sum, added);
    sum_words[place] = sum.x;
    sum_words[place + 1u] = sum.y;
}

void write_collected(uint importon, bool final_gather, Collected collected) {
    uint place = first_word(importon, final_gather);
    write_words(place, collected.red);
    write_words(place + 2u, collected.green);
    write_words(place + 4u, collected.blue);
    if (parameters.counting == 0u) return;
    if (collected.diffused > 0u) photon_counts[global_photon_place(importon)] += collected.diffused;
    if (!final_gather && collected.caustic > 0u) photon_counts[caustic_place(importon)] += collected.caustic;
    place = signed_place(importon, final_gather);
    uvec2 sum = uvec2(photon_counts[place], photon_counts[place + 1u]);
    add_words(sum, collected.with_signs);
    photon_counts[place] = sum.x;
    photon_counts[place + 1u] = sum.y;
}
