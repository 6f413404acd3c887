// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of what photons add to importons, in whole quanta of radiance: 64 bits in two words, since the sum of integers
// does not depend on their order and that of floats does. For each pixel of the band they are six, low words first:
// three channels of what its importons take, and three of what its gathering ray finds.

#include "common/whole_numbers.glsl"

const float WORD = 4294967296.0;
const float MOST_QUANTA = 4611686018427387904.0;  // 2^62

uint first_word(uint pixel, bool final_gather) { return 12u * pixel + (final_gather ? 6u : 0u); }

// Where the photons are counted that a pixel takes: global ones, and caustic ones that its disk holds by those taken,
// but for those at the ends of gathering rays. Behind them lie two signed sums of 64 bits.
uint global_photon_place(uint pixel) { return 6u * pixel; }
uint caustic_place(uint pixel) { return 6u * pixel + 1u; }

// Where the luminance of what photons add is summed with a random sign for each photon path: with independent signs the
// sum's square has the mean of the sum of squares, the variance of what photons bring for given camera paths.
uint signed_place(uint pixel, bool final_gather) { return 6u * pixel + (final_gather ? 4u : 2u); }

// Low and high word of a number of quanta, rounded; of negative ones the two's complement.
uvec2 whole_quanta(float signed_quanta) {
    float quanta = abs(signed_quanta);
    if (!(quanta >= 0.5)) return uvec2(0u);
    quanta = min(quanta, MOST_QUANTA);
    float high = floor(quanta / WORD);
    // What a float cannot count in whole quanta already is whole.
    float rest = quanta - high * WORD;
    uvec2 words = uvec2(whole_word(rest < 8388608.0 ? floor(rest + 0.5) : rest), whole_word(high));
    return signed_quanta < 0.0 ? uvec2(~words.x + 1u, ~words.y + (words.x == 0u ? 1u : 0u)) : words;
}

// A sum of three channels from its words: by magnitude, since next to 2^32 floats do not count in ones.
vec3 quanta_of(uvec3 low, uvec3 high) {
    uvec3 negative = high >> 31u, turned = negative * 0xffffffffu;
    low = (low ^ turned) + negative;
    high = (high ^ turned) + negative * uvec3(equal(low, uvec3(0u)));
    return (vec3(high) * WORD + vec3(low)) * (1.0 - 2.0 * vec3(negative));
}
