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

// A function for each operation.
#define MATH(function, expression) \
    void function(int use_clamp, float a, float b, float c, out float result) { \
        result = expression; \
        if (use_clamp != 0) result = clamp(result, 0.0, 1.0); \
    }
MATH(node_math_add, a + b)
MATH(node_math_subtract, a - b)
MATH(node_math_multiply, a *b)
MATH(node_math_divide, safe_divide(a, b))
MATH(node_math_multiply_add, a *b + c)
MATH(node_math_power, safe_power(a, b))
MATH(node_math_logarithm, safe_logarithm(a, b))
MATH(node_math_sqrt, sqrt(max(a, 0.0)))
MATH(node_math_inverse_sqrt, a > 0.0 ? inversesqrt(a) : 0.0)
MATH(node_math_absolute, abs(a))
MATH(node_math_exponent, exp(a))
MATH(node_math_minimum, min(a, b))
MATH(node_math_maximum, max(a, b))
MATH(node_math_less_than, a < b ? 1.0 : 0.0)
MATH(node_math_greater_than, a > b ? 1.0 : 0.0)
MATH(node_math_sign, sign(a))
MATH(node_math_compare, abs(a - b) <= max(c, 1.1920929e-7) ? 1.0 : 0.0)
MATH(node_math_smooth_min, smooth_minimum(a, b, c))
MATH(node_math_smooth_max, -smooth_minimum(-a, -b, c))
MATH(node_math_round, floor(a + 0.5))
MATH(node_math_floor, floor(a))
MATH(node_math_ceil, ceil(a))
MATH(node_math_trunc, trunc(a))
MATH(node_math_fract, a - floor(a))
MATH(node_math_modulo, safe_modulo(a, b))
MATH(node_math_floored_modulo, safe_floored_modulo(a, b))
MATH(node_math_wrap, wrap(a, b, c))
MATH(node_math_snap, floor(safe_divide(a, b)) * b)
MATH(node_math_pingpong, pingpong(a, b))
MATH(node_math_sine, sin(a))
MATH(node_math_cosine, cos(a))
MATH(node_math_tangent, tan(a))
MATH(node_math_arcsine, arc_sine(clamp(a, -1.0, 1.0)))
MATH(node_math_arccosine, arc_cosine(clamp(a, -1.0, 1.0)))
MATH(node_math_arctangent, arc_tangent(a))
MATH(node_math_arctan2, arc_tangent2(a, b))
MATH(node_math_sinh, sinh(a))
MATH(node_math_cosh, cosh(a))
MATH(node_math_tanh, tanh(a))
MATH(node_math_radians, radians(a))
MATH(node_math_degrees, degrees(a))
#undef MATH
