// SPDX-License-Identifier: GPL-3.0-or-later
// Lobes of a closure: microfacets that reflect or refract, and sheen. n is a lobe's own normal.

#include <MicrofacetLobe>
#include "common/bsdf/diffuse.glsl"
#include "common/bsdf/fresnel.glsl"
#include "common/bsdf/ggx.glsl"
#include "common/bsdf/sheen.glsl"

#include <MicrofacetKinds>

bool lobe_transmits(uint kind) { return kind >= LOBE_GLASS && kind <= LOBE_SHEET; }
bool lobe_is_sheen(uint kind) { return kind == LOBE_SHEEN || kind == LOBE_VELVET; }

// Of these lobes f0 is a share of the light, as weight is of the others'.
bool passes_by_f0(uint kind) { return kind == LOBE_GLASS || kind == LOBE_COATED_GLASS; }

// Kind and tint in one word, as closures and importons keep them.
uint pack_kind(uint kind, vec3 tint) {
    uvec3 parts = uvec3(whole_part(clamp(tint, 0.0, 1.0) * vec3(511.0, 1023.0, 511.0) + 0.5));
    return kind | (parts.r << 4u) | (parts.g << 13u) | (parts.b << 23u);
}
uint unpack_kind(uint bits) { return bits & 0xfu; }
vec3 unpack_tint(uint bits) {
    return vec3((uvec3(bits) >> uvec3(4u, 13u, 23u)) & uvec3(511u, 1023u, 511u)) / vec3(511.0, 1023.0, 511.0);
}

// What a normal map takes from light to or from wi; smooth_normal: packed, without the map.
float lobe_shadowing(MicrofacetLobe lobe, uint smooth_normal, vec3 wi) {
    return lobe.kind == LOBE_SHEEN ? bump_shadowing(unpack_unit_vector(smooth_normal), unpack_unit_vector(lobe.normal),
                                                    wi) : 1.0;
}

vec3 lobe_normal(MicrofacetLobe lobe) { return unpack_unit_vector(lobe.normal); }

// Share of what glass-like lobes reflect, gray: by it they choose between reflection and refraction.
float reflected_share(MicrofacetLobe lobe, float cosine) {
    if (lobe.kind == LOBE_GLASS) return fresnel_dielectric(cosine, lobe.ior);
    if (lobe.kind == LOBE_COATED_GLASS)
        return mix(clamp(largest(lobe.tint), 0.01, 0.99), 1.0, dielectric_interpolation(cosine, lobe.ior));
    return lobe.kind == LOBE_REFRACTION || lobe.kind == LOBE_SHEET ? 0.0 : 1.0;
}

// Reflected share per channel at a microfacet, without the lobe's weight.
vec3 lobe_reflectance(MicrofacetLobe lobe, float cosine) {
    if (lobe.kind == LOBE_MIRROR) return vec3(1.0);
    if (lobe.kind == LOBE_METAL) return f82_reflectance(lobe.f0, lobe.tint, cosine);
    if (lobe.kind == LOBE_DIELECTRIC) return mix(lobe.f0, vec3(1.0), dielectric_interpolation(cosine, lobe.ior));
    if (lobe.kind == LOBE_GLASS) return tinted_dielectric(cosine, lobe.ior, lobe.tint);
    if (lobe.kind == LOBE_COATED_GLASS) return mix(lobe.tint, vec3(1.0), dielectric_interpolation(cosine, lobe.ior));
    if (lobe_is_sheen(lobe.kind)) return vec3(1.0);
    return vec3(0.0);
}

// Tint and share of what passes a microfacet, without total internal reflection.
vec3 lobe_transmittance(MicrofacetLobe lobe, float cosine) {
    if (lobe.kind == LOBE_GLASS || lobe.kind == LOBE_COATED_GLASS)
        return lobe.f0 * (1.0 - lobe_reflectance(lobe, cosine));
    if (lobe.kind == LOBE_REFRACTION || lobe.kind == LOBE_SHEET) return lobe.weight;
    return vec3(0.0);
}

// Estimate of the lobe's albedo toward a direction, for choosing among lobes.
vec3 lobe_albedo(MicrofacetLobe lobe, float cosine) {
    vec3 albedo = lobe.weight * lobe_reflectance(lobe, cosine);
    return lobe_transmits(lobe.kind) ? albedo + lobe_transmittance(lobe, cosine) : albedo;
}

// A sheet is asked as the mirror that it is for light from the other side. wi: where light comes from.
void face_sheet(inout MicrofacetLobe lobe, vec3 n, inout vec3 wi) {
    if (lobe.kind != LOBE_SHEET) return;
    lobe.kind = LOBE_MIRROR;
    wi = reflect(wi, n);
}

// What sampling a lobe gives: a direction and f cos / pdf. weight is zero when nothing is scattered.
struct LobeSample { vec3 direction; vec3 weight; bool transmitted; };

LobeSample sample_lobe(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 u, float u_event, bool radiance) {
    LobeSample result = LobeSample(n, vec3(0.0), false);
    bool sheet = lobe.kind == LOBE_SHEET;
    if (sheet) lobe.kind = LOBE_MIRROR;
    if (dot(wo, n) <= 0.0) return result;
    if (lobe_is_sheen(lobe.kind)) {
        SheenFrame sheen = sheen_frame(n, wo);
        bool fitted = lobe.kind == LOBE_SHEEN;
        result.direction = fitted ? sample_sheen(lobe.f0.xy, sheen, u) : sample_cosine_hemisphere(n, u);
        float cosine_i = dot(n, result.direction);
        if (cosine_i <= 0.0) return result;
        result.weight = lobe.weight * (fitted ? 1.0
                                       : velvet_scattered(lobe.f0.x, n, wo, result.direction) * PI / cosine_i);
        return result;
    }
    MicrofacetFrame frame = microfacet_frame(n, lobe.alpha, lobe.anisotropy);
    vec3 local_wo = to_frame(frame, wo);
    bool smooth_lobe = lobe.alpha < 1e-6;
    vec3 local_h = sample_visible_normal(local_wo, frame.alpha, u);
    vec3 h = smooth_lobe ? n : from_frame(frame, local_h);
    float cosine = dot(wo, h);
    if (cosine <= 0.0) return result;
    vec3 reflected = lobe.weight * lobe_reflectance(lobe, cosine);
    float probability = reflected_share(lobe, cosine);
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
    if (!smooth_lobe) {
        float lambda_o = facet_lambda(frame, local_wo),
            lambda_i = facet_lambda(frame, to_frame(frame, result.direction));
        float ratio = frame.beckmann ? beckmann_ratio(local_h, frame.alpha) : 1.0;
        result.weight *= ratio * (1.0 + ggx_lambda(local_wo, frame.alpha)) / (1.0 + lambda_o + lambda_i);
    }
    if (sheet) {
        result.direction = reflect(result.direction, n);
        result.transmitted = true;
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
    face_sheet(lobe, n, wi);
    float cosine_o = dot(wo, n), cosine_i = dot(wi, n);
    if (lobe_is_sheen(lobe.kind)) {
        if (cosine_o <= 0.0 || cosine_i <= 0.0) return vec3(0.0);
        float scattered = lobe.kind == LOBE_SHEEN ? sheen_pdf(lobe.f0.xy, n, wo, wi)
                                                  : velvet_scattered(lobe.f0.x, n, wo, wi);
        return lobe.weight * (scattered / cosine_i);
    }
    vec3 h;
    float oh, ih;
    if (!linking_normal(lobe, n, wo, wi, h, oh, ih)) return vec3(0.0);
    MicrofacetFrame frame = microfacet_frame(n, lobe.alpha, lobe.anisotropy);
    float distribution = facet_distribution(frame, to_frame(frame, h));
    float masking = 1.0 / (1.0 + facet_lambda(frame, to_frame(frame, wo)) + facet_lambda(frame, to_frame(frame, wi)));
    if (cosine_i > 0.0)
        return lobe.weight * lobe_reflectance(lobe, oh) * (distribution * masking / (4.0 * cosine_o * cosine_i));
    float spread = lobe.ior * ih + oh;
    return lobe_transmittance(lobe, oh)
        * (distribution * masking * abs(ih) * oh / (cosine_o * abs(cosine_i) * max(spread * spread, 1e-12)));
}

// Density with which sample_lobe gives a direction, 1/sr.
float lobe_pdf(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    face_sheet(lobe, n, wi);
    if (lobe_is_sheen(lobe.kind))
        return lobe.kind == LOBE_SHEEN ? sheen_pdf(lobe.f0.xy, n, wo, wi) : max(dot(n, wi), 0.0) / PI;
    vec3 h;
    float oh, ih;
    if (!linking_normal(lobe, n, wo, wi, h, oh, ih)) return 0.0;
    MicrofacetFrame frame = microfacet_frame(n, lobe.alpha, lobe.anisotropy);
    float cosine_o = dot(wo, n);
    float visible = ggx_distribution(to_frame(frame, h), frame.alpha) * oh
                    / (cosine_o * (1.0 + ggx_lambda(to_frame(frame, wo), frame.alpha)));
    float reflected = reflected_share(lobe, oh);
    if (dot(wi, n) > 0.0) return visible * reflected / (4.0 * oh);
    float spread = lobe.ior * ih + oh;
    return visible * (1.0 - reflected) * lobe.ior * lobe.ior * abs(ih) / max(spread * spread, 1e-12);
}
