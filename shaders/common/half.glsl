// SPDX-License-Identifier: GPL-3.0-or-later
// Half floats by integers alone: nouveau drops programs that call unpackHalf2x16, and reports no error to OpenGL.

float half_to_float(uint bits) {
    uint exponent = bitfieldExtract(bits, 10, 5), mantissa = bits & 0x3ffu;
    uint rebased = exponent == 31u ? 255u : exponent + 112u;
    float normal = uintBitsToFloat(rebased << 23 | mantissa << 13);
    float magnitude = exponent == 0u ? float(mantissa) * 5.9604644775390625e-8 : normal;
    return (bits & 0x8000u) != 0u ? -magnitude : magnitude;
}

// The first in the lower half.
vec2 two_halves(uint bits) { return vec2(half_to_float(bits & 0xffffu), half_to_float(bits >> 16)); }

// The nearest half float to a number from 0 to the greatest one.
uint float_to_half(float value) {
    value = clamp(value, 0.0, 65504.0);
    if (value < 6.103515625e-5) return uint(value * 16777216.0 + 0.5);
    return (floatBitsToUint(value) + 0x1000u >> 13) - (112u << 10);
}
