// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/safe.glsl"

vec3 project(vec3 a, vec3 b) {
    float size2 = dot(b, b);
    return size2 != 0.0 ? dot(a, b) / size2 * b : vec3(0.0);
}

// Less exact than that of numbers: just below a multiple of b it may return b's share of rounding instead of b.
vec3 vector_modulo(vec3 a, vec3 b) { return vec3(notEqual(b, vec3(0.0))) * (a - b * trunc(safe_divide(a, b))); }

void node_vector_math(
    int operation, vec3 a, vec3 b, vec3 c, float scale, out vec3 vector, out float value) {
    vector = vec3(0.0);
    value = 0.0;
    switch (operation) {
    case 0: vector = a + b; break;                              // ADD
    case 1: vector = a - b; break;                              // SUBTRACT
    case 2: vector = a * b; break;                              // MULTIPLY
    case 3: vector = safe_divide(a, b); break;                  // DIVIDE
    case 4: vector = a * b + c; break;                          // MULTIPLY_ADD
    case 5: vector = cross(a, b); break;                        // CROSS_PRODUCT
    case 6: vector = project(a, b); break;                      // PROJECT
    case 7: vector = reflect(a, safe_normalize(b)); break;      // REFLECT
    case 8: vector = refract(a, safe_normalize(b), scale); break; // REFRACT
    case 9: vector = faceforward(a, b, c); break;               // FACEFORWARD
    case 10: value = dot(a, b); break;                          // DOT_PRODUCT
    case 11: value = distance(a, b); break;                     // DISTANCE
    case 12: value = length(a); break;                          // LENGTH
    case 13: vector = a * scale; break;                         // SCALE
    case 14: vector = safe_normalize(a); break;                 // NORMALIZE
    case 15: vector = abs(a); break;                            // ABSOLUTE
    case 16: vector = safe_power(a, b); break;                  // POWER
    case 17: vector = sign(a); break;                           // SIGN
    case 18: vector = min(a, b); break;                         // MINIMUM
    case 19: vector = max(a, b); break;                         // MAXIMUM
    case 20: vector = floor(a); break;                          // FLOOR
    case 21: vector = ceil(a); break;                           // CEIL
    case 22: vector = a - floor(a); break;                      // FRACTION
    case 23: vector = vector_modulo(a, b); break;                 // MODULO
    case 24: vector = wrap(a, b, c); break;                     // WRAP
    case 25: vector = floor(safe_divide(a, b)) * b; break;      // SNAP
    case 26: vector = sin(a); break;                            // SINE
    case 27: vector = cos(a); break;                            // COSINE
    default: vector = tan(a); break;                            // TANGENT
    }
}
