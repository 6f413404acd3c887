// SPDX-License-Identifier: GPL-3.0-or-later
// Arithmetic that is defined everywhere, as Cycles' nodes are: what has no value is 0.

float safe_divide(float a, float b) { return b != 0.0 ? a / b : 0.0; }

vec3 safe_divide(vec3 a, vec3 b) { return vec3(safe_divide(a.x, b.x), safe_divide(a.y, b.y), safe_divide(a.z, b.z)); }

// Powers of negative numbers exist for whole exponents only; 0 has no inverse.
float safe_power(float base, float exponent) {
    if (exponent == 0.0) return 1.0;
    if (base == 0.0) return 0.0;
    bool whole = exponent == trunc(exponent);
    if (base < 0.0 && !whole) return 0.0;
    float power = pow(abs(base), exponent);
    bool odd = fract(exponent * 0.5) != 0.0;
    return base < 0.0 && odd ? -power : power;
}

vec3 safe_power(vec3 base, vec3 exponent) {
    return vec3(safe_power(base.x, exponent.x), safe_power(base.y, exponent.y), safe_power(base.z, exponent.z));
}

float safe_logarithm(float a, float base) { return a > 0.0 && base > 0.0 ? safe_divide(log(a), log(base)) : 0.0; }

// The leading half of a float's digits: products of two such are exact.
float leading_half(float a) { return uintBitsToFloat(floatBitsToUint(a) & 0xfffff000u); }

// The remainder has the sign of a. The quotient may have been rounded up to a whole number and be one off, which
// shows only where its product with the divisor is exact.
float safe_modulo(float a, float b) {
    if (b == 0.0) return 0.0;
    float size = abs(a), divisor = abs(b), quotient = trunc(size / divisor);
    float q = leading_half(quotient), d = leading_half(divisor);
    precise float remainder =
        ((size - q * d) - q * (divisor - d)) - (quotient - q) * d - (quotient - q) * (divisor - d);
    if (remainder < 0.0) remainder += divisor;
    if (remainder >= divisor) remainder -= divisor;
    return a < 0.0 ? -remainder : remainder;
}

// The remainder has the sign of b.
float safe_floored_modulo(float a, float b) { return b != 0.0 ? a - floor(a / b) * b : 0.0; }

// Into [low, high) by whole ranges.
float wrap(float value, float high, float low) {
    float range = high - low;
    return range != 0.0 ? value - range * floor((value - low) / range) : low;
}

vec3 wrap(vec3 value, vec3 high, vec3 low) {
    return vec3(wrap(value.x, high.x, low.x), wrap(value.y, high.y, low.y), wrap(value.z, high.z, low.z));
}

vec3 safe_normalize(vec3 v) {
    float size = length(v);
    return size != 0.0 ? v / size : v;
}
