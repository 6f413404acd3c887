// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/arc_functions.glsl"
#include "materials/nodes/safe.glsl"

float pingpong(float a, float scale) {
    return scale != 0.0 ? abs(fract((a - scale) / (2.0 * scale)) * scale * 2.0 - scale) : 0.0;
}

// The smaller of two, with a cubic blend where they are nearer than `distance`.
float smooth_minimum(float a, float b, float distance) {
    if (distance == 0.0) return min(a, b);
    float h = max(distance - abs(a - b), 0.0) / distance;
    return min(a, b) - h * h * h * distance * (1.0 / 6.0);
}

float math(int operation, float a, float b, float c) {
    switch (operation) {
    case 0: return a + b;                        // ADD
    case 1: return a - b;                        // SUBTRACT
    case 2: return a * b;                        // MULTIPLY
    case 3: return safe_divide(a, b);            // DIVIDE
    case 4: return a * b + c;                    // MULTIPLY_ADD
    case 5: return safe_power(a, b);             // POWER
    case 6: return safe_logarithm(a, b);         // LOGARITHM
    case 7: return sqrt(max(a, 0.0));            // SQRT
    case 8: return a > 0.0 ? inversesqrt(a) : 0.0; // INVERSE_SQRT
    case 9: return abs(a);                       // ABSOLUTE
    case 10: return exp(a);                      // EXPONENT
    case 11: return min(a, b);                   // MINIMUM
    case 12: return max(a, b);                   // MAXIMUM
    case 13: return a < b ? 1.0 : 0.0;           // LESS_THAN
    case 14: return a > b ? 1.0 : 0.0;           // GREATER_THAN
    case 15: return sign(a);                     // SIGN
    case 16: return abs(a - b) <= max(c, 1.1920929e-7) ? 1.0 : 0.0; // COMPARE
    case 17: return smooth_minimum(a, b, c);     // SMOOTH_MIN
    case 18: return -smooth_minimum(-a, -b, c);  // SMOOTH_MAX
    case 19: return floor(a + 0.5);              // ROUND
    case 20: return floor(a);                    // FLOOR
    case 21: return ceil(a);                     // CEIL
    case 22: return trunc(a);                    // TRUNC
    case 23: return a - floor(a);                // FRACT
    case 24: return safe_modulo(a, b);           // MODULO
    case 25: return safe_floored_modulo(a, b);   // FLOORED_MODULO
    case 26: return wrap(a, b, c);               // WRAP
    case 27: return floor(safe_divide(a, b)) * b; // SNAP
    case 28: return pingpong(a, b);              // PINGPONG
    case 29: return sin(a);                      // SINE
    case 30: return cos(a);                      // COSINE
    case 31: return tan(a);                      // TANGENT
    case 32: return arc_sine(clamp(a, -1.0, 1.0)); // ARCSINE
    case 33: return arc_cosine(clamp(a, -1.0, 1.0)); // ARCCOSINE
    case 34: return arc_tangent(a);              // ARCTANGENT
    case 35: return arc_tangent2(a, b);          // ARCTAN2
    case 36: return sinh(a);                     // SINH
    case 37: return cosh(a);                     // COSH
    case 38: return tanh(a);                     // TANH
    case 39: return radians(a);                  // RADIANS
    default: return degrees(a);                  // DEGREES
    }
}

void node_math(int operation, int use_clamp, float value, float value_001, float value_002, out float result) {
    result = math(operation, value, value_001, value_002);
    if (use_clamp != 0) result = clamp(result, 0.0, 1.0);
}
