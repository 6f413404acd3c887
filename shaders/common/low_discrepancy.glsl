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

uint owen_scramble(uint x, uint seed) { return bitfieldReverse(laine_karras(bitfieldReverse(x), seed)); }

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

// Columns of the generator matrices of the third and fourth Sobol dimensions (Joe and Kuo, 2008), lowest bits first.
const uvec2 SOBOL_THIRD_FOURTH[16] =
    uvec2[16](uvec2(0x1u, 0x1u), uvec2(0x3u, 0x3u), uvec2(0x6u, 0x4u), uvec2(0x9u, 0xau), uvec2(0x17u, 0x1fu),
              uvec2(0x3au, 0x2eu), uvec2(0x71u, 0x45u), uvec2(0xa3u, 0xc9u), uvec2(0x116u, 0x11bu),
              uvec2(0x339u, 0x2a4u), uvec2(0x677u, 0x79au), uvec2(0x9aau, 0xb67u), uvec2(0x1601u, 0x101eu),
              uvec2(0x3903u, 0x302du), uvec2(0x7706u, 0x4041u), uvec2(0xaa09u, 0xa0c3u));

// Bits of these dimensions, lowest first, by the lowest 16 bits of the index: sets of more points repeat them.
uvec2 sobol_third_fourth_reversed(uint index) {
    uvec2 bits = uvec2(0u);
    for (uint k = 0u; k < 16u; ++k) bits ^= SOBOL_THIRD_FOURTH[k] * ((index >> k) & 1u);
    return bits;
}

// Point `index` of a four-dimensional set, whose first two numbers are those of scrambled_sobol. Of the points whose
// third number lies in some interval, such as that of a lobe or of a light, the others are evenly spread as well.
vec4 scrambled_sobol4(uint index, uvec4 seed) {
    uint shuffled = owen_scramble(index, seed.x);
    uvec2 more = sobol_third_fourth_reversed(shuffled);
    return vec4(unit_float(bitfieldReverse(laine_karras(shuffled, seed.y))),
                unit_float(bitfieldReverse(laine_karras(sobol_second_reversed(shuffled), seed.z))),
                unit_float(bitfieldReverse(laine_karras(more.x, seed.w))),
                unit_float(bitfieldReverse(laine_karras(more.y, seed.x * 747796405u + seed.y))));
}
