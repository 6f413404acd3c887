// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/constants.glsl"
#include "common/whole_numbers.glsl"

// Octahedral unit vectors in two 16-bit parts (Cigolle et al., JCGT 2014).
vec2 octahedral_fold(vec2 v) {
    return (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

uint pack_unit_vector(vec3 v) {
    v /= abs(v.x) + abs(v.y) + abs(v.z);
    // packSnorm2x16, which drivers on the processor do one thread after the other
    ivec2 parts = nearest_whole(clamp(v.z >= 0.0 ? v.xy : octahedral_fold(v.xy), -1.0, 1.0) * 32767.0);
    return uint(parts.x & 0xffff) | uint(parts.y) << 16u;
}

vec3 unpack_unit_vector(uint bits) {
    vec2 p = unpackSnorm2x16(bits);
    vec3 v = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (v.z < 0.0) v.xy = octahedral_fold(v.xy);
    return normalize(v);
}

// Two unit vectors that complete n to a frame (Duff et al., JCGT 2017).
void tangent_frame(vec3 n, out vec3 t, out vec3 b) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float c = n.x * n.y * a;
    t = vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x);
    b = vec3(c, s + n.y * n.y * a, -n.y);
}

// A point just off the surface on the side of n (Waechter and Binder, Ray Tracing Gems, ch. 6):
// the step follows the coordinates' float spacing.
vec3 offset_from_surface(vec3 p, vec3 n) {
    ivec3 steps = whole_part(256.0 * n);
    vec3 stepped = vec3(
        intBitsToFloat(floatBitsToInt(p.x) + (p.x < 0.0 ? -steps.x : steps.x)),
        intBitsToFloat(floatBitsToInt(p.y) + (p.y < 0.0 ? -steps.y : steps.y)),
        intBitsToFloat(floatBitsToInt(p.z) + (p.z < 0.0 ? -steps.z : steps.z)));
    vec3 plain = p + n * (1.0 / 65536.0);
    bvec3 small = lessThan(abs(p), vec3(1.0 / 32.0));
    return mix(stepped, plain, small);
}

// By magnitude: light may be negative, as in Cycles.
float largest(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }
