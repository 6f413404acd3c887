// SPDX-License-Identifier: GPL-3.0-or-later
// Owen-scrambled Sobol points by hashing: Burley, Practical Hash-based Owen Scrambling (JCGT 2020).

#include "common/random.glsl"

uint laine_karras(uint x, uint seed) {
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

uint owen_scramble(uint x, uint seed) {
    return bitfieldReverse(laine_karras(bitfieldReverse(x), seed));
}

// Bits of the second Sobol dimension, lowest first: its generator matrix is Pascal's triangle modulo 2, which has a one
// where the bits of the column's number include those of the row's.
uint sobol_second_reversed(uint index) {
    index ^= (index >> 1u) & 0x55555555u;
    index ^= (index >> 2u) & 0x33333333u;
    index ^= (index >> 4u) & 0x0f0f0f0fu;
    index ^= (index >> 8u) & 0x00ff00ffu;
    return index ^ (index >> 16u);
}

// Point `index` of a two-dimensional set; sets of different seeds are independent shuffles.
vec2 scrambled_sobol(uint index, uvec4 seed) {
    uint shuffled = owen_scramble(index, seed.x);
    return vec2(unit_float(bitfieldReverse(laine_karras(shuffled, seed.y))),
                unit_float(bitfieldReverse(laine_karras(sobol_second_reversed(shuffled), seed.z))));
}
