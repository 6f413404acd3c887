// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/constants.glsl"
#include "common/whole_numbers.glsl"

// Octahedral unit vectors in two 16-bit parts (Cigolle et al., JCGT 2014).
vec2 octahedral_fold(vec2 v) { return (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }

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

// By magnitude: light may be negative, as in Cycles.
float largest(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// How far off its plane a ray begins that leaves a triangle, meters, so that it meets no neighbor in the same plane:
// what rounding of the point (Pharr, Jakob and Humphreys, Physically Based Rendering, 6.8) and of the neighbor's test
// (common/intersection.glsl) come to, eight times over. n: the plane's normal.
float ray_offset(vec3 n, vec3 v0, vec3 v1, vec3 v2) {
    const float ROUNDING = 1.0 / 2097152.0;  // eight half steps of floats near 1
    vec3 most = max(max(abs(v0), abs(v1)), abs(v2));
    vec3 extent = max(max(v0, v1), v2) - min(min(v0, v1), v2);
    return ROUNDING * (dot(abs(n), most) + largest(extent));
}
