// SPDX-License-Identifier: GPL-3.0-or-later
// Counter-based random numbers: a value depends on (seed, iteration, stage, index, dimension) only.
// Jarzynski and Olano, Hash Functions for GPU Rendering (JCGT 2020): pcg4d.

#include <RandomStages>

uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Below 1 for every argument: 24 bits are all that a float keeps.
float unit_float(uint bits) { return float(bits >> 8u) * (1.0 / 16777216.0); }

// Four values per counter step; segment distinguishes the bounces of a path.
struct RandomSequence {
    uvec4 key;
    uvec4 block;
    uint used;
};

RandomSequence random_sequence(uint seed, uint iteration, uint stage, uint segment, uint index) {
    RandomSequence sequence;
    sequence.key = uvec4(index, iteration, seed, (stage << 24u) | (segment << 12u));
    sequence.block = uvec4(0u);
    sequence.used = 4u;
    return sequence;
}

float next_random(inout RandomSequence sequence) {
    if (sequence.used == 4u) {
        sequence.block = pcg4d(sequence.key);
        sequence.key.w += 1u;
        sequence.used = 0u;
    }
    uint bits = sequence.used == 0u   ? sequence.block.x
                : sequence.used == 1u ? sequence.block.y
                : sequence.used == 2u ? sequence.block.z
                                      : sequence.block.w;
    sequence.used += 1u;
    return unit_float(bits);
}

// Four numbers that fill the unit cube evenly as the iterations of a pixel go by: Roberts' R4 sequence
// (2018) from a random start; the constants are 2^32 g^-k, g^5 = g + 1.
vec4 progressive_random(uint seed, uint iteration, uint stage, uint segment, uint index) {
    uvec4 start = pcg4d(uvec4(index, 0u, seed, (stage << 24u) | (segment << 12u)));
    uvec4 bits = start + iteration * uvec4(3679390609u, 3152041523u, 2700274805u, 2313257605u);
    return vec4(unit_float(bits.x), unit_float(bits.y), unit_float(bits.z), unit_float(bits.w));
}

vec2 next_random2(inout RandomSequence sequence) {
    float first = next_random(sequence);
    return vec2(first, next_random(sequence));
}
