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

// Second Sobol dimension: its generator matrix is Pascal's triangle modulo 2.
uint sobol_second(uint index) {
    uint result = 0u;
    for (uint vector = 0x80000000u; index != 0u; index >>= 1u, vector ^= vector >> 1u)
        if ((index & 1u) != 0u) result ^= vector;
    return result;
}

// Point `index` of a two-dimensional set; sets of different seeds are independent shuffles.
vec2 scrambled_sobol(uint index, uvec4 seed) {
    uint shuffled = owen_scramble(index, seed.x);
    return vec2(unit_float(owen_scramble(bitfieldReverse(shuffled), seed.y)),
                unit_float(owen_scramble(sobol_second(shuffled), seed.z)));
}
