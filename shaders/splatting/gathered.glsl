// SPDX-License-Identifier: GPL-3.0-or-later
// Radiance gathered by each importon, added to by many threads at once: sums of whole quanta in 64 bits, as a
// low and a high word, since the sum of integers does not depend on their order and that of floats does.
// The includer declares the storage block of photons[].

layout(std430, binding = 4) buffer Gathered { uint gathered_words[]; };

const float WORD = 4294967296.0;
const float MOST_QUANTA = 4611686018427387904.0;  // 2^62

void add_quanta(uint place, float quanta) {
    if (!(quanta >= 0.5)) return;
    quanta = min(quanta, MOST_QUANTA);
    float high = floor(quanta / WORD);
    // What a float cannot count in whole quanta already is whole.
    float rest = quanta - high * WORD;
    uint low = uint(rest < 8388608.0 ? floor(rest + 0.5) : rest), carry = uint(high);
    if (low > 0u && atomicAdd(gathered_words[place], low) > 0xffffffffu - low) carry += 1u;
    if (carry > 0u) atomicAdd(gathered_words[place + 1u], carry);
}

// Threads that meet here write the same mark.
void add_gathered(uint importon, uint photon, vec3 radiance, float quanta) {
    photons[photon].contributed = 1u;
    add_quanta(6u * importon, radiance.r * quanta);
    add_quanta(6u * importon + 2u, radiance.g * quanta);
    add_quanta(6u * importon + 4u, radiance.b * quanta);
}
