// SPDX-License-Identifier: GPL-3.0-or-later
// Russian roulette of splats (paper section 4.2, Fig. 5): half of the pairs of a photon and a pixel are left out, and
// the quanta of the others count twice. Needs the member roulette of the parameters; 0 keeps all.
#include "common/random.glsl"

bool rejected(uint photon, uint pixel) {
    uvec4 key = uvec4(photon, pixel, parameters.roulette, STAGE_SPLATTING);
    return parameters.roulette != 0u && (pcg4d(key).x & 0x80000000u) != 0u;
}
