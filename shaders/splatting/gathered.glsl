// SPDX-License-Identifier: GPL-3.0-or-later
// Radiance gathered by each importon, added to by many threads at once. Core GLSL has no float
// atomics, so the sum is exchanged until it is the one that was read.

layout(std430, binding = 4) buffer Gathered { uint gathered_bits[]; };

void add_bits(uint place, float value) {
    if (value == 0.0) return;
    uint expected = gathered_bits[place];
    for (;;) {
        uint found = atomicCompSwap(gathered_bits[place], expected, floatBitsToUint(uintBitsToFloat(expected) + value));
        if (found == expected) return;
        expected = found;
    }
}

void add_gathered(uint importon, vec3 radiance) {
    add_bits(3u * importon, radiance.r);
    add_bits(3u * importon + 1u, radiance.g);
    add_bits(3u * importon + 2u, radiance.b);
}
