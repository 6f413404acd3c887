// SPDX-License-Identifier: GPL-3.0-or-later
// How often lobes of each type have scattered a path: four counts in a word, one for each Scatter, which stay at the
// largest number that they have room for. Those of a photon and of the camera path that takes it add up.
#include <BounceCounting>
#include <PathHistory>

const uint MAX_COUNT = (1u << COUNT_BITS) - 1u;

uint count_of(uint counts, uint scatter) { return (counts >> COUNT_BITS * (scatter - SCATTER_DIFFUSE)) & MAX_COUNT; }

uvec4 counts_of(uint counts) { return (uvec4(counts) >> COUNT_BITS * uvec4(0u, 1u, 2u, 3u)) & MAX_COUNT; }

// The counts behind one more scattering.
uint counted(uint counts, uint scatter) {
    return count_of(counts, scatter) < MAX_COUNT ? counts + (1u << COUNT_BITS * (scatter - SCATTER_DIFFUSE)) : counts;
}

// The Scatter by which a bounce counts: as in Cycles, translucent surfaces transmit.
uint counted_scatter(uint scatter, bool transmitted) {
    return scatter == SCATTER_DIFFUSE && transmitted ? SCATTER_TRANSMISSION : scatter;
}
