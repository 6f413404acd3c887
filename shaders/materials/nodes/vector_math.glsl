// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/safe.glsl"

vec3 project(vec3 a, vec3 b) {
    float size2 = dot(b, b);
    return size2 != 0.0 ? dot(a, b) / size2 * b : vec3(0.0);
}

// Less exact than that of numbers: just below a multiple of b it may return b's part of the rounding instead of b.
vec3 vector_modulo(vec3 a, vec3 b) { return vec3(notEqual(b, vec3(0.0))) * (a - b * trunc(safe_divide(a, b))); }

// A function for each operation.
#define VECTOR_MATH(function, vector_result, value_result) \
    void function(vec3 a, vec3 b, vec3 c, float scale, out vec3 vector, out float value) { \
        vector = vector_result; \
        value = value_result; \
    }
VECTOR_MATH(node_vector_math_add, a + b, 0.0)
VECTOR_MATH(node_vector_math_subtract, a - b, 0.0)
VECTOR_MATH(node_vector_math_multiply, a *b, 0.0)
VECTOR_MATH(node_vector_math_divide, safe_divide(a, b), 0.0)
VECTOR_MATH(node_vector_math_multiply_add, a *b + c, 0.0)
VECTOR_MATH(node_vector_math_cross_product, cross(a, b), 0.0)
VECTOR_MATH(node_vector_math_project, project(a, b), 0.0)
VECTOR_MATH(node_vector_math_reflect, reflect(a, safe_normalize(b)), 0.0)
VECTOR_MATH(node_vector_math_refract, refract(a, safe_normalize(b), scale), 0.0)
VECTOR_MATH(node_vector_math_faceforward, faceforward(a, b, c), 0.0)
VECTOR_MATH(node_vector_math_dot_product, vec3(0.0), dot(a, b))
VECTOR_MATH(node_vector_math_distance, vec3(0.0), distance(a, b))
VECTOR_MATH(node_vector_math_length, vec3(0.0), length(a))
VECTOR_MATH(node_vector_math_scale, a *scale, 0.0)
VECTOR_MATH(node_vector_math_normalize, safe_normalize(a), 0.0)
VECTOR_MATH(node_vector_math_absolute, abs(a), 0.0)
VECTOR_MATH(node_vector_math_power, safe_power(a, b), 0.0)
VECTOR_MATH(node_vector_math_sign, sign(a), 0.0)
VECTOR_MATH(node_vector_math_minimum, min(a, b), 0.0)
VECTOR_MATH(node_vector_math_maximum, max(a, b), 0.0)
VECTOR_MATH(node_vector_math_floor, floor(a), 0.0)
VECTOR_MATH(node_vector_math_ceil, ceil(a), 0.0)
VECTOR_MATH(node_vector_math_fraction, a - floor(a), 0.0)
VECTOR_MATH(node_vector_math_modulo, vector_modulo(a, b), 0.0)
VECTOR_MATH(node_vector_math_wrap, wrap(a, b, c), 0.0)
VECTOR_MATH(node_vector_math_snap, floor(safe_divide(a, b)) * b, 0.0)
VECTOR_MATH(node_vector_math_sine, sin(a), 0.0)
VECTOR_MATH(node_vector_math_cosine, cos(a), 0.0)
VECTOR_MATH(node_vector_math_tangent, tan(a), 0.0)
#undef VECTOR_MATH
