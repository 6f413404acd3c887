// SPDX-License-Identifier: GPL-3.0-or-later
// Ashikhmin and Shirley's anisotropic Phong model (2000) of a mirror's microfacets, as Cycles has it: without a Fresnel
// term, and with the exponents of Beckmann's distribution of the same alpha. In the frame of ggx.glsl.

// Below that alpha it is a mirror.
const float SMOOTHEST_PHONG = 1e-6;

// The sum of both exponents by the fractions of a microfacet's tilt along the axes.
float phong_exponent(vec2 exponents, vec2 along) { return dot(exponents, along * along); }

vec2 phong_exponents(vec2 alpha) {
    alpha = clamp(alpha, 1e-4, 1.0);
    return 2.0 / (alpha * alpha) - 2.0;
}

// log(1 - x), for small x as well.
float log_of_rest(float x) { return x < 1e-2 ? -x * (1.0 + x * (0.5 + x / 3.0)) : log(max(1.0 - x, 1e-20)); }
// 1 - exp(-x), likewise.
float rest_of_exp(float x) { return x < 1e-2 ? x * (1.0 - x * (0.5 - x / 6.0)) : 1.0 - exp(-x); }

// Microfacets' density, 1/sr.
float phong_distribution(vec3 h, vec2 alpha) {
    vec2 exponents = phong_exponents(alpha);
    float tilt2 = dot(h.xy, h.xy);
    float exponent = tilt2 > 0.0 ? phong_exponent(exponents, h.xy * inversesqrt(tilt2)) : 0.0;
    return sqrt((exponents.x + 1.0) * (exponents.y + 1.0)) / (2.0 * PI)
           * exp(0.5 * exponent * log_of_rest(min(tilt2, 1.0)));
}

// By that density. d: of the unit disk.
vec3 sample_phong_normal(vec2 alpha, vec2 d) {
    vec2 exponents = phong_exponents(alpha), along = d * sqrt(exponents.yx + 1.0);
    float length2 = dot(along, along);
    if (length2 <= 0.0) return vec3(0.0, 0.0, 1.0);
    along *= inversesqrt(length2);
    float tilt2 = rest_of_exp(-2.0 * log_of_rest(dot(d, d)) / (phong_exponent(exponents, along) + 1.0));
    return vec3(sqrt(tilt2) * along, sqrt(max(1.0 - tilt2, 0.0)));
}
