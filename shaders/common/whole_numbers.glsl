// SPDX-License-Identifier: GPL-3.0-or-later
// int() of floats whose magnitude is below 2^22 and not NaN, by the bits of a sum: around 1.5 * 2^23 neighboring
// floats are 1 apart. Drivers on the processor convert one thread after the other, and units of a GPU convert at a
// fraction of the rate at which they add.
const float WHOLE_NUMBERS = 12582912.0;
const int WHOLE_NUMBER_BITS = 0x4b400000;

int whole_part(float x) { return floatBitsToInt(trunc(x) + WHOLE_NUMBERS) - WHOLE_NUMBER_BITS; }
ivec2 whole_part(vec2 x) { return floatBitsToInt(trunc(x) + WHOLE_NUMBERS) - WHOLE_NUMBER_BITS; }
ivec3 whole_part(vec3 x) { return floatBitsToInt(trunc(x) + WHOLE_NUMBERS) - WHOLE_NUMBER_BITS; }
ivec4 whole_part(vec4 x) { return floatBitsToInt(trunc(x) + WHOLE_NUMBERS) - WHOLE_NUMBER_BITS; }

// The nearest whole numbers, even ones of two that are as near.
ivec2 nearest_whole(vec2 x) {
    precise vec2 sum = x + WHOLE_NUMBERS;
    return floatBitsToInt(sum) - WHOLE_NUMBER_BITS;
}

// uint() of a whole number below 2^32.
uint whole_word(float x) {
    float upper = floor(x * (1.0 / 65536.0)), lower = x - 65536.0 * upper;
    return uint(whole_part(upper)) << 16u | uint(whole_part(lower));
}
