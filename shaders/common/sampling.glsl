// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/geometry.glsl"

// Power heuristic (Veach 1997, section 9.2.4): the MIS weight of the first of two techniques that sample a
// direction.
float power_heuristic(float pdf, float other_pdf) {
    float ratio = other_pdf / pdf;
    return pdf > 0.0 ? 1.0 / (1.0 + ratio * ratio) : 0.0;
}

// Whether the newest of several candidates is taken in place of those before, by its weight; weights: the sum with it.
// u: uniform in [0, 1), before as after (weighted reservoir sampling with one random number).
bool reservoir_accept(float weight, float weights, inout float u) {
    u *= weights;
    bool taken = u < weight;
    u = taken ? u / weight : (u - weight) / max(weights - weight, 1e-30);
    return taken;
}

// Concentric map of the unit square to the unit disk (Shirley and Chiu 1997).
vec2 sample_disk(vec2 u) {
    vec2 p = 2.0 * u - 1.0;
    if (p.x == 0.0 && p.y == 0.0) return vec2(0.0);
    float r, angle;
    if (abs(p.x) > abs(p.y)) {
        r = p.x;
        angle = (PI / 4.0) * (p.y / p.x);
    } else {
        r = p.y;
        angle = PI / 2.0 - (PI / 4.0) * (p.x / p.y);
    }
    return r * vec2(cos(angle), sin(angle));
}

// The point of the unit square that sample_disk maps to p.
vec2 disk_to_square(vec2 p) {
    if (p.x == 0.0 && p.y == 0.0) return vec2(0.5);
    bool wide = abs(p.x) > abs(p.y);
    float r = length(p) * ((wide ? p.x : p.y) < 0.0 ? -1.0 : 1.0);
    float across = r * (4.0 / PI) * atan(wide ? p.y / p.x : p.x / p.y);
    return 0.5 + 0.5 * (wide ? vec2(r, across) : vec2(across, r));
}

// Around n with density cosine / pi, of a point evenly spread on the unit disk.
vec3 cosine_hemisphere(vec3 n, vec2 d) {
    vec3 t, b;
    tangent_frame(n, t, b);
    return normalize(d.x * t + d.y * b + sqrt(max(0.0, 1.0 - dot(d, d))) * n);
}

vec3 sample_cosine_hemisphere(vec3 n, vec2 u) { return cosine_hemisphere(n, sample_disk(u)); }

vec2 hemisphere_to_square(vec3 n, vec3 direction) {
    vec3 t, b;
    tangent_frame(n, t, b);
    return disk_to_square(vec2(dot(direction, t), dot(direction, b)));
}

// Around axis, uniform in solid angle within the cone of this cosine. one_minus_cosine keeps small cones exact.
vec3 sample_cone(vec3 axis, float one_minus_cosine, vec2 u) {
    float drop = u.x * one_minus_cosine;
    float sine = sqrt(max(0.0, drop * (2.0 - drop)));
    float angle = 2.0 * PI * u.y;
    vec3 t, b;
    tangent_frame(axis, t, b);
    return normalize(sine * (cos(angle) * t + sin(angle) * b) + (1.0 - drop) * axis);
}

vec2 cone_to_square(vec3 axis, float one_minus_cosine, vec3 direction) {
    vec3 t, b;
    tangent_frame(axis, t, b);
    return vec2((1.0 - dot(direction, axis)) / one_minus_cosine,
                fract(atan(dot(direction, b), dot(direction, t)) / (2.0 * PI)));
}

vec3 sample_sphere(vec2 u) {
    float z = 1.0 - 2.0 * u.x;
    float r = sqrt(max(0.0, 1.0 - z * z));
    float angle = 2.0 * PI * u.y;
    return vec3(r * cos(angle), r * sin(angle), z);
}

vec2 sphere_to_square(vec3 direction) {
    return vec2(0.5 - 0.5 * direction.z, fract(atan(direction.y, direction.x) / (2.0 * PI)));
}

// The direction at an angle of this cosine to an axis; u: of the angle around it, in [0, 1).
vec3 direction_around(vec3 axis, float cosine, float u) {
    vec3 t, b;
    tangent_frame(axis, t, b);
    float angle = 2.0 * PI * u, sine = sqrt(max(0.0, 1.0 - cosine * cosine));
    return normalize(sine * (cos(angle) * t + sin(angle) * b) + cosine * axis);
}
