// SPDX-License-Identifier: GPL-3.0-or-later
// Anisotropic microfacets, GGX or Beckmann, with height-correlated masking (Walter et al. 2007; Heitz 2014, 2018), in
// the coordinates of a frame whose z is the normal.

#include "common/sampling.glsl"

struct MicrofacetFrame {
    vec3 t;
    vec3 b;
    vec3 n;
    vec2 alpha;
    bool beckmann;
};

// Direction and ratio of the axes in two 16-bit parts: where the rougher axis meets the diamond |x| + |y| = 1, y >= 0,
// about the normal's own tangent frame, and sqrt(smaller alpha / greater alpha).
const uint ISOTROPIC = 0xffff0000u;
// The lowest bit is no part of the direction.
const uint BECKMANN = 1u;

MicrofacetFrame microfacet_frame(vec3 n, float alpha, uint anisotropy) {
    vec2 axes = unpackUnorm2x16(anisotropy & ~BECKMANN);
    vec3 t, b;
    tangent_frame(n, t, b);
    vec2 along = vec2(1.0 - 2.0 * axes.x, 1.0 - abs(1.0 - 2.0 * axes.x));
    along *= inversesqrt(dot(along, along));
    float aspect = max(axes.y, 1e-3);
    return MicrofacetFrame(along.x * t + along.y * b, along.x * b - along.y * t, n,
                           max(vec2(alpha / aspect, alpha * aspect), 1e-7), (anisotropy & BECKMANN) != 0u);
}

// Anisotropy whose greater alpha lies along the tangent; n as a lobe keeps it, unpacked again.
uint pack_anisotropy(vec3 n, vec3 tangent, float aspect) {
    vec3 t, b;
    tangent_frame(n, t, b);
    vec2 along = vec2(dot(tangent, t), dot(tangent, b));
    if (aspect >= 1.0 || dot(along, along) < 1e-12) return ISOTROPIC;
    if (along.y < 0.0) along = -along;
    return packUnorm2x16(vec2(0.5 - 0.5 * along.x / (abs(along.x) + along.y), aspect)) & ~BECKMANN;
}

vec3 to_frame(MicrofacetFrame frame, vec3 v) { return vec3(dot(v, frame.t), dot(v, frame.b), dot(v, frame.n)); }
vec3 from_frame(MicrofacetFrame frame, vec3 v) { return v.x * frame.t + v.y * frame.b + v.z * frame.n; }

float ggx_distribution(vec3 h, vec2 alpha) {
    vec3 stretched = vec3(h.xy / alpha, h.z);
    float length2 = dot(stretched, stretched);
    return 1.0 / (PI * alpha.x * alpha.y * length2 * length2);
}

float ggx_lambda(vec3 w, vec2 alpha) {
    vec2 stretched = alpha * w.xy;
    return 0.5 * (sqrt(1.0 + dot(stretched, stretched) / max(w.z * w.z, 1e-12)) - 1.0);
}

// Beckmann's over GGX's density at the same normal, at most 4/e: GGX's visible normals serve as samples of both.
float beckmann_ratio(vec3 h, vec2 alpha) {
    vec2 slope = h.xy / (alpha * max(h.z, 1e-6));
    float x = dot(slope, slope);
    return (1.0 + x) * (1.0 + x) * exp(-min(x, 80.0));
}

// By Walter's rational fit.
float beckmann_lambda(vec3 w, vec2 alpha) {
    vec2 stretched = alpha * w.xy;
    float x = dot(stretched, stretched) / max(w.z * w.z, 1e-12);
    float a = inversesqrt(max(x, 1e-12));
    return x < 0.39 ? 0.0 : (1.0 + a * (0.396 * a - 1.259)) / (a * (3.535 + 2.181 * a));
}

float facet_distribution(MicrofacetFrame frame, vec3 h) {
    return ggx_distribution(h, frame.alpha) * (frame.beckmann ? beckmann_ratio(h, frame.alpha) : 1.0);
}

float facet_lambda(MicrofacetFrame frame, vec3 w) {
    return frame.beckmann ? beckmann_lambda(w, frame.alpha) : ggx_lambda(w, frame.alpha);
}

// By the density of GGX's visible normals (Heitz, JCGT 2018). p: of the unit disk.
vec3 sample_visible_normal(vec3 wo, vec2 alpha, vec2 p) {
    vec3 v = normalize(vec3(alpha * wo.xy, max(wo.z, 1e-6)));
    float length2 = dot(v.xy, v.xy);
    vec3 t1 = length2 > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(length2) : vec3(1.0, 0.0, 0.0);
    vec3 t2 = cross(v, t1);
    float s = 0.5 * (1.0 + v.z);
    p.y = (1.0 - s) * sqrt(max(0.0, 1.0 - p.x * p.x)) + s * p.y;
    vec3 h = p.x * t1 + p.y * t2 + sqrt(max(0.0, 1.0 - dot(p, p))) * v;
    return normalize(vec3(alpha * h.xy, max(1e-9, h.z)));
}
