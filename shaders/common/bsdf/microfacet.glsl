// SPDX-License-Identifier: GPL-3.0-or-later
// Isotropic GGX microfacets with height-correlated masking (Walter et al. 2007; Heitz 2014, 2018).

#include <MicrofacetLobe>
#include "common/sampling.glsl"
#include "common/bsdf/fresnel.glsl"

const uint LOBE_NONE = 0u;
const uint LOBE_MIRROR = 1u;       // reflects all
const uint LOBE_METAL = 2u;        // Schlick's Fresnel from f0 to white
const uint LOBE_DIELECTRIC = 3u;   // reflection of a dielectric, f0 tinted
const uint LOBE_GLASS = 4u;        // reflects and refracts
const uint LOBE_REFRACTION = 5u;   // refracts only, without Fresnel's loss

bool lobe_transmits(uint kind) { return kind == LOBE_GLASS || kind == LOBE_REFRACTION; }

// Reflected share per channel at a microfacet, without the lobe's weight.
vec3 lobe_reflectance(MicrofacetLobe lobe, float cosine) {
    if (lobe.kind == LOBE_MIRROR) return vec3(1.0);
    if (lobe.kind == LOBE_METAL) return mix(lobe.f0, vec3(1.0), schlick_interpolation(cosine));
    if (lobe.kind == LOBE_DIELECTRIC) return mix(lobe.f0, vec3(1.0), dielectric_interpolation(cosine, lobe.ior));
    if (lobe.kind == LOBE_GLASS) return vec3(fresnel_dielectric(cosine, lobe.ior));
    return vec3(0.0);
}

// Tint and share of what passes a microfacet, without total internal reflection.
vec3 lobe_transmittance(MicrofacetLobe lobe, float cosine) {
    if (lobe.kind == LOBE_GLASS) return lobe.f0 * (1.0 - fresnel_dielectric(cosine, lobe.ior));
    if (lobe.kind == LOBE_REFRACTION) return lobe.weight;
    return vec3(0.0);
}

// Estimate of the lobe's albedo towards a direction, for choosing among lobes.
vec3 lobe_albedo(MicrofacetLobe lobe, float cosine) {
    vec3 albedo = lobe.weight * lobe_reflectance(lobe, cosine);
    return lobe_transmits(lobe.kind) ? albedo + lobe_transmittance(lobe, cosine) : albedo;
}

float ggx_density(float cosine, float alpha) {
    float a2 = alpha * alpha;
    float d = cosine * cosine * (a2 - 1.0) + 1.0;
    return a2 / (PI * d * d);
}

float ggx_lambda(float cosine, float alpha) {
    float c2 = max(cosine * cosine, 1e-12);
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - c2) / c2) - 1.0);
}

// Visible normals in the frame of n (Heitz, JCGT 2018).
vec3 sample_visible_normal(vec3 n, vec3 wo, float alpha, vec2 u) {
    if (alpha < 1e-6) return n;
    vec3 t, b;
    tangent_frame(n, t, b);
    vec3 v = normalize(vec3(alpha * dot(wo, t), alpha * dot(wo, b), max(dot(wo, n), 1e-6)));
    float length2 = v.x * v.x + v.y * v.y;
    vec3 t1 = length2 > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(length2) : vec3(1.0, 0.0, 0.0);
    vec3 t2 = cross(v, t1);
    vec2 p = sample_disk(u);
    float s = 0.5 * (1.0 + v.z);
    p.y = (1.0 - s) * sqrt(max(0.0, 1.0 - p.x * p.x)) + s * p.y;
    vec3 h = p.x * t1 + p.y * t2 + sqrt(max(0.0, 1.0 - dot(p, p))) * v;
    return normalize(alpha * (h.x * t + h.y * b) + max(1e-9, h.z) * n);
}

// What sampling a lobe gives: a direction and f cos / pdf. weight is zero when nothing is scattered.
struct LobeSample { vec3 direction; vec3 weight; bool transmitted; };

LobeSample sample_lobe(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 u, float u_event, bool radiance) {
    LobeSample result = LobeSample(n, vec3(0.0), false);
    vec3 h = sample_visible_normal(n, wo, lobe.alpha, u);
    float cosine = dot(wo, h);
    if (cosine <= 0.0) return result;
    vec3 reflected = lobe.weight * lobe_reflectance(lobe, cosine);
    float probability = 1.0;
    if (lobe.kind == LOBE_GLASS) probability = fresnel_dielectric(cosine, lobe.ior);
    if (lobe.kind == LOBE_REFRACTION) probability = 0.0;
    if (u_event < probability) {
        result.direction = normalize(2.0 * cosine * h - wo);
        result.weight = reflected / probability;
        if (dot(result.direction, n) <= 0.0) result.weight = vec3(0.0);
    } else {
        float k = 1.0 - (1.0 - cosine * cosine) / (lobe.ior * lobe.ior);
        if (k <= 0.0) return result;  // total internal reflection: a lobe without reflection scatters nothing
        result.direction = normalize((cosine / lobe.ior - sqrt(k)) * h - wo / lobe.ior);
        result.transmitted = true;
        result.weight = lobe_transmittance(lobe, cosine) / (1.0 - probability);
        // radiance shrinks with the beam's solid angle; flux does not (Veach 1997, section 5.2)
        if (radiance) result.weight /= lobe.ior * lobe.ior;
        if (dot(result.direction, n) >= 0.0) result.weight = vec3(0.0);
    }
    if (lobe.alpha >= 1e-6) {
        float lambda_o = ggx_lambda(dot(wo, n), lobe.alpha);
        float lambda_i = ggx_lambda(dot(result.direction, n), lobe.alpha);
        result.weight *= (1.0 + lambda_o) / (1.0 + lambda_o + lambda_i);
    }
    return result;
}

// Of a pair of directions: the microfacet normal that links them and their cosines to it. False when
// the lobe links none.
bool linking_normal(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi, out vec3 h, out float oh, out float ih) {
    float cosine_o = dot(wo, n), cosine_i = dot(wi, n);
    h = n;
    oh = ih = 0.0;
    if (cosine_o <= 0.0 || cosine_i == 0.0 || lobe.kind == LOBE_NONE) return false;
    bool transmitted = cosine_i < 0.0;
    if (transmitted && !lobe_transmits(lobe.kind)) return false;
    h = transmitted ? -(lobe.ior * wi + wo) : wi + wo;
    float length_h = length(h);
    if (length_h < 1e-8) return false;
    h /= length_h;
    if (transmitted && lobe.ior < 1.0) h = -h;
    oh = dot(wo, h);
    ih = dot(wi, h);
    return dot(h, n) > 0.0 && oh > 0.0 && (transmitted ? ih < 0.0 : ih > 0.0);
}

// BSDF for radiance that arrives from wi and leaves to wo (unit vectors away from the surface), 1/sr.
vec3 evaluate_lobe(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    vec3 h;
    float oh, ih;
    if (!linking_normal(lobe, n, wo, wi, h, oh, ih)) return vec3(0.0);
    float cosine_o = dot(wo, n), cosine_i = dot(wi, n);
    float density = ggx_density(dot(h, n), lobe.alpha);
    float masking = 1.0 / (1.0 + ggx_lambda(cosine_o, lobe.alpha) + ggx_lambda(cosine_i, lobe.alpha));
    if (cosine_i > 0.0)
        return lobe.weight * lobe_reflectance(lobe, oh) * (density * masking / (4.0 * cosine_o * cosine_i));
    float spread = lobe.ior * ih + oh;
    return lobe_transmittance(lobe, oh)
        * (density * masking * abs(ih) * oh / (cosine_o * abs(cosine_i) * max(spread * spread, 1e-12)));
}

// Density with which sample_lobe gives a direction, 1/sr.
float lobe_density(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    vec3 h;
    float oh, ih;
    if (!linking_normal(lobe, n, wo, wi, h, oh, ih)) return 0.0;
    float cosine_o = dot(wo, n);
    float visible = ggx_density(dot(h, n), lobe.alpha) * oh / (cosine_o * (1.0 + ggx_lambda(cosine_o, lobe.alpha)));
    float reflected = lobe.kind == LOBE_GLASS ? fresnel_dielectric(oh, lobe.ior) : (lobe.kind == LOBE_REFRACTION ? 0.0 : 1.0);
    if (dot(wi, n) > 0.0) return visible * reflected / (4.0 * oh);
    float spread = lobe.ior * ih + oh;
    return visible * (1.0 - reflected) * lobe.ior * lobe.ior * abs(ih) / max(spread * spread, 1e-12);
}
