// SPDX-License-Identifier: GPL-3.0-or-later
// Lobes of a closure: microfacets that reflect or refract, sheen, toon and hair. n is a lobe's own normal.

#include <MicrofacetLobe>
#include "common/bsdf/diffuse.glsl"
#include "common/bsdf/fresnel.glsl"
#include "common/bsdf/ggx.glsl"
#include "common/bsdf/sheen.glsl"
#include "common/bsdf/toon.glsl"
#include "common/luminance.glsl"

#include <MicrofacetKinds>
#include <HairLobes>

// Scenes without hair have programs that know none.
#ifdef HAIR_LOBES
#include "common/bsdf/hair.glsl"
bool lobe_is_hair(uint kind) { return kind >= LOBE_HAIR_REFLECTION; }
#else
bool lobe_is_hair(uint kind) { return false; }
#endif

// Likewise without Ashikhmin and Shirley's model, whose lobes are mirrors with a black tint.
#ifdef ASHIKHMIN_LOBES
#include "common/bsdf/ashikhmin_shirley.glsl"
bool lobe_is_ashikhmin(MicrofacetLobe lobe) { return lobe.kind == LOBE_MIRROR && lobe.tint.x < 0.5; }
#endif

bool lobe_transmits(uint kind) { return (kind >= LOBE_GLASS && kind <= LOBE_SHEET) || lobe_is_hair(kind); }
bool lobe_is_toon(uint kind) { return kind >= LOBE_TOON && !lobe_is_hair(kind); }
bool lobe_has_facets(uint kind) { return kind < LOBE_SHEEN; }
// For Cycles, as are the diffuse parts of a closure.
// Whether the viewer is on the normal's side makes no difference then.
bool lobe_is_diffuse(uint kind) { return kind == LOBE_SHEEN || kind == LOBE_TOON; }

// Whether light from a direction with that cosine to the lobe's normal counts, which comes from the front of the
// surface or not: for hair from all around.
bool lobe_faces(MicrofacetLobe lobe, float cosine, bool front) {
    return (cosine > 0.0) == front || lobe_is_hair(lobe.kind);
}

// Of these lobes f0 is a fraction of the light, as weight is of the others'.
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
    return lobe_is_diffuse(lobe.kind)
               ? bump_shadowing(unpack_unit_vector(smooth_normal), unpack_unit_vector(lobe.normal), wi)
               : 1.0;
}

#include "common/bsdf/film_lobes.glsl"

vec3 lobe_normal(MicrofacetLobe lobe) { return unpack_unit_vector(lobe.normal); }

// Reflectance and transmittance of a microfacet. Drivers without calls repeat the code of a function at each call, so
// that one function computes all of them, and compilers leave out what a caller does not read.
struct FacetFresnel {
    vec3 reflectance;              // per channel, without the lobe's weight
    vec3 transmittance;            // per channel, with the tint, without total internal reflection
    float reflection_probability;  // gray: lobes like glass choose by it between reflection and refraction
};

FacetFresnel facet_fresnel(MicrofacetLobe lobe, float cosine) {
    float reflectance = fresnel_dielectric(cosine, lobe.ior), f0 = normal_reflectance(lobe.ior);
    float rise = interpolation_of(reflectance, f0);
    bool coated_glass = lobe.kind == LOBE_COATED_GLASS, glass = lobe.kind == LOBE_GLASS || coated_glass,
         passes = lobe.kind == LOBE_REFRACTION || lobe.kind == LOBE_SHEET;
    FacetFresnel fresnel = FacetFresnel(vec3(0.0), vec3(0.0), passes ? 0.0 : 1.0);
    if (lobe.kind == LOBE_METAL) fresnel.reflectance = f82_reflectance(abs(lobe.f0), lobe.tint, cosine);
    else if (coated_glass) fresnel.reflectance = vec3(reflectance);
    else if (glass) fresnel.reflectance = tinted_reflectance(reflectance, f0, lobe.tint);
    else if (lobe.kind == LOBE_DIELECTRIC) fresnel.reflectance = mix(abs(lobe.f0), vec3(1.0), rise);
    else if (lobe.kind == LOBE_MIRROR || !lobe_has_facets(lobe.kind)) fresnel.reflectance = vec3(1.0);
    if (glass) fresnel.reflection_probability = reflectance;
    // Films, as hair. What adds lobes to closures takes them for bare where it estimates their albedo.
#ifdef THIN_FILM_LOBES
    if (lobe_has_film(lobe)) {
        fresnel.reflectance = covered_reflectance(lobe, cosine);
        if (glass && reflectance < 1.0)
            fresnel.reflection_probability = clamp(largest(fresnel.reflectance), 0.01, 0.99);
    }
#endif
    if (glass) fresnel.transmittance = lobe.f0 * (1.0 - fresnel.reflectance);
    else if (passes) fresnel.transmittance = lobe.weight;
    return fresnel;
}

// Estimate of the lobe's albedo toward a direction, for choosing among lobes.
vec3 lobe_albedo(MicrofacetLobe lobe, float cosine) {
    FacetFresnel fresnel = facet_fresnel(lobe, cosine);
    vec3 albedo = lobe.weight * fresnel.reflectance;
#ifdef HAIR_LOBES
    if (lobe_is_hair(lobe.kind)) return hair_albedo(lobe, cosine);
#endif
    return lobe_transmits(lobe.kind) ? albedo + fresnel.transmittance : albedo;
}

// A sheet is asked as the mirror that it is for light from the other side. wi: where light comes from.
void face_sheet(inout MicrofacetLobe lobe, vec3 n, inout vec3 wi) {
    if (lobe.kind != LOBE_SHEET) return;
    lobe.kind = LOBE_MIRROR;
    wi = reflect(wi, n);
}

// What sampling a lobe gives: a direction and f cos / pdf. weight is zero when nothing is scattered.
struct LobeSample {
    vec3 direction;
    vec3 weight;
    bool transmitted;
};

// Of microfacets. Values are chosen in place of left early: what a branch leaves behind is kept beside what others
// compute, and processors have few registers.
LobeSample sample_microfacets(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 disk, float uc, bool radiance) {
    bool sheet = lobe.kind == LOBE_SHEET, smooth_lobe = lobe.alpha < 1e-6;
    if (sheet) lobe.kind = LOBE_MIRROR;
    MicrofacetFrame frame = microfacet_frame(n, lobe.alpha, lobe.anisotropy);
    vec3 local_wo = to_frame(frame, wo);
    vec3 local_h = sample_visible_normal(local_wo, frame.alpha, disk);
    vec3 h = smooth_lobe ? n : from_frame(frame, local_h);
    float cosine = dot(wo, h);
    FacetFresnel fresnel = facet_fresnel(lobe, cosine);
    float probability = fresnel.reflection_probability, k = 1.0 - (1.0 - cosine * cosine) / (lobe.ior * lobe.ior);
    bool reflected = uc < probability;
    // Where total internal reflection is, a lobe without reflection scatters nothing.
    bool scattered = !(cosine <= 0.0) && (reflected || !(k <= 0.0));
    LobeSample result;
    result.direction = normalize(reflected ? 2.0 * cosine * h - wo : (cosine / lobe.ior - sqrt(k)) * h - wo / lobe.ior);
    result.weight =
        reflected ? lobe.weight * fresnel.reflectance / probability : fresnel.transmittance / (1.0 - probability);
    // Both over the squared index of where they are (basic radiance): a refracted beam keeps that of its radiance, and
    // flux, which stays what it is, is over another index (Veach 1997, section 5.2).
    if (!radiance && !reflected) result.weight /= lobe.ior * lobe.ior;
    float side = dot(result.direction, n);
    if (!scattered || (reflected ? side <= 0.0 : side >= 0.0)) result.weight = vec3(0.0);
    if (!smooth_lobe) {
        float lambda_o = facet_lambda(frame, local_wo),
              lambda_i = facet_lambda(frame, to_frame(frame, result.direction));
        float ratio = frame.beckmann ? beckmann_ratio(local_h, frame.alpha) : 1.0;
        float factor = ratio * (1.0 + ggx_lambda(local_wo, frame.alpha)) / (1.0 + lambda_o + lambda_i);
        if (scattered) result.weight *= factor;
    }
    if (sheet) result.direction = reflect(result.direction, n);
    if (!scattered) result.direction = n;
    result.transmitted = scattered && (sheet || !reflected);
    return result;
}

#ifdef ASHIKHMIN_LOBES
// What reflects to below the surface is lost.
LobeSample sample_ashikhmin(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 disk) {
    MicrofacetFrame frame = microfacet_frame(n, lobe.alpha, lobe.anisotropy);
    vec3 h = lobe.alpha < SMOOTHEST_PHONG ? n : from_frame(frame, sample_phong_normal(frame.alpha, disk));
    float cosine = dot(wo, h);
    vec3 wi = normalize(2.0 * cosine * h - wo);
    float cosine_o = dot(n, wo), cosine_i = dot(n, wi);
    bool scattered = cosine > 0.0 && cosine_i > 0.0;
    return LobeSample(wi, scattered ? lobe.weight * (cosine_i / max(cosine_i, cosine_o)) : vec3(0.0), false);
}
#endif

// What a viewer sees depends on where the light is, not the other way round: photons go all ways.
LobeSample sample_toon_lobe(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 disk, bool radiance) {
    bool diffuse = lobe.kind == LOBE_TOON, evenly = diffuse && !radiance;
    vec3 axis = diffuse ? n : reflect(-wo, n);
    vec3 direction = evenly ? cosine_hemisphere(n, disk) : sample_toon(lobe.f0, axis, disk);
    float cosine_o = dot(n, wo), cosine_i = dot(n, direction);
    float scale = radiance ? 1.0 : (evenly ? PI * toon_pdf(lobe.f0) : cosine_i) / cosine_o;
    float intensity = toon_intensity(lobe.f0, evenly ? cosine_o : dot(axis, direction));
    return LobeSample(direction, cosine_i > 0.0 ? lobe.weight * (scale * intensity) : vec3(0.0), false);
}

// disk: sample_disk of two random numbers, which callers that choose among lobes and diffuse parts have anyway.
LobeSample sample_lobe(MicrofacetLobe lobe, vec3 n, vec3 wo, vec2 disk, float uc, bool radiance) {
    LobeSample result;
#ifdef HAIR_LOBES
    if (lobe_is_hair(lobe.kind)) {
        result.direction = sample_hair(lobe, n, wo, disk, uc, radiance, result.weight);
        result.transmitted = dot(result.direction, n) < 0.0;
        return result;
    }
#endif
#ifdef ASHIKHMIN_LOBES
    if (lobe_is_ashikhmin(lobe)) result = sample_ashikhmin(lobe, n, wo, disk);
    else
#endif
        if (lobe_has_facets(lobe.kind))
        result = sample_microfacets(lobe, n, wo, disk, uc, radiance);
    else if (lobe_is_toon(lobe.kind)) result = sample_toon_lobe(lobe, n, wo, disk, radiance);
    else {
        SheenFrame sheen = sheen_frame(n, wo);
        bool fitted = lobe.kind == LOBE_SHEEN;
        result.direction = fitted ? sample_sheen(lobe.f0.xy, sheen, disk) : cosine_hemisphere(n, disk);
        float cosine_i = dot(n, result.direction);
        result.weight =
            lobe.weight * (fitted ? 1.0 : velvet_scattered(lobe.f0.x, n, wo, result.direction) * PI / cosine_i);
        if (cosine_i <= 0.0) result.weight = vec3(0.0);
        result.transmitted = false;
    }
    if (dot(wo, n) <= 0.0 && !(radiance && lobe_is_diffuse(lobe.kind))) return LobeSample(n, vec3(0.0), false);
    return result;
}

// Of a pair of directions: the microfacet normal that links them and their cosines to it. False when the lobe links
// none. All at once: what branches leave undone would have to be kept as well.
bool linking_normal(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi, out vec3 h, out float oh, out float ih) {
    float cosine_o = dot(wo, n), cosine_i = dot(wi, n);
    bool transmitted = cosine_i < 0.0, behind = transmitted && lobe.ior < 1.0;
    h = transmitted ? -(lobe.ior * wi + wo) : wi + wo;
    float length_h = length(h);
    h /= length_h;
    if (behind) h = -h;
    oh = dot(wo, h);
    ih = dot(wi, h);
    return cosine_o > 0.0 && cosine_i != 0.0 && lobe.kind != LOBE_NONE && !(transmitted && !lobe_transmits(lobe.kind))
           && length_h >= 1e-8 && dot(h, n) > 0.0 && oh > 0.0 && (transmitted ? ih < 0.0 : ih > 0.0);
}

// What a lobe gives of a pair of directions, unit vectors away from the surface.
struct LobeValue {
    vec3 bsdf;  // for radiance over the squared index that arrives from wi and leaves to wo, 1/sr
    float pdf;  // with which sample_lobe gives wi, 1/sr
};

LobeValue microfacet_value(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    float cosine_o = dot(wo, n), cosine_i = dot(wi, n);
    vec3 h;
    float oh, ih;
    bool linked = linking_normal(lobe, n, wo, wi, h, oh, ih);
    // Where the facets lie first: of that two numbers are kept while the colors are computed.
    MicrofacetFrame frame = microfacet_frame(n, lobe.alpha, lobe.anisotropy);
    vec3 local_h = to_frame(frame, h), local_wo = to_frame(frame, wo), local_wi = to_frame(frame, wi);
    float distribution = facet_distribution(frame, local_h);
    float masking = 1.0 / (1.0 + facet_lambda(frame, local_wo) + facet_lambda(frame, local_wi));
    float visible =
        ggx_distribution(local_h, frame.alpha) * oh / (cosine_o * (1.0 + ggx_lambda(local_wo, frame.alpha)));
    bool reflected = cosine_i > 0.0;
    float spread = lobe.ior * ih + oh;
    float spread2 = max(spread * spread, 1e-12);
    float ior2 = lobe.ior * lobe.ior;
    float factor = reflected ? distribution * masking / (4.0 * cosine_o * cosine_i)
                             : distribution * masking * ior2 * abs(ih) * oh / (cosine_o * abs(cosine_i) * spread2);
    FacetFresnel fresnel = facet_fresnel(lobe, oh);
    LobeValue value;
    value.bsdf = factor * (reflected ? lobe.weight * fresnel.reflectance : fresnel.transmittance);
    value.pdf = reflected ? visible * fresnel.reflection_probability / (4.0 * oh)
                          : visible * (1.0 - fresnel.reflection_probability) * ior2 * abs(ih) / spread2;
    if (!linked) return LobeValue(vec3(0.0), 0.0);
    return value;
}

#ifdef ASHIKHMIN_LOBES
LobeValue ashikhmin_value(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
    float cosine_o = dot(wo, n), cosine_i = dot(wi, n);
    vec3 h = normalize(wi + wo);
    MicrofacetFrame frame = microfacet_frame(n, lobe.alpha, lobe.anisotropy);
    float pdf = phong_distribution(to_frame(frame, h), frame.alpha) / (4.0 * max(dot(h, wo), 1e-6));
    if (!(cosine_o > 0.0 && cosine_i > 0.0)) return LobeValue(vec3(0.0), 0.0);
    return LobeValue(lobe.weight * (pdf / max(cosine_o, cosine_i)), pdf);
}
#endif

LobeValue lobe_value(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
#ifdef HAIR_LOBES
    if (lobe_is_hair(lobe.kind)) {
        HairValue hair = hair_value(lobe, n, wo, wi);
        return LobeValue(hair.scattered / max(abs(dot(wi, n)), 1e-20), hair.pdf);
    }
#endif
#ifdef ASHIKHMIN_LOBES
    if (lobe_is_ashikhmin(lobe)) return ashikhmin_value(lobe, n, wo, wi);
#endif
    face_sheet(lobe, n, wi);
    if (lobe_has_facets(lobe.kind)) return microfacet_value(lobe, n, wo, wi);
    float cosine_o = dot(wo, n), cosine_i = dot(wi, n);
    if (lobe_is_toon(lobe.kind)) {
        float intensity = toon_intensity(lobe.f0, dot(lobe.kind == LOBE_TOON ? n : reflect(-wo, n), wi));
        float pdf =
            (cosine_o > 0.0 || lobe.kind == LOBE_TOON) && cosine_i > 0.0 && intensity > 0.0 ? toon_pdf(lobe.f0) : 0.0;
        return LobeValue(lobe.weight * (pdf * intensity / max(cosine_i, 1e-20)), pdf);
    }
    bool fitted = lobe.kind == LOBE_SHEEN;
    float fitted_pdf = sheen_pdf(lobe.f0.xy, n, wo, wi);
    LobeValue value = LobeValue(vec3(0.0), fitted ? fitted_pdf : max(dot(n, wi), 0.0) / PI);
    if ((cosine_o > 0.0 || fitted) && cosine_i > 0.0)
        value.bsdf = lobe.weight * ((fitted ? fitted_pdf : velvet_scattered(lobe.f0.x, n, wo, wi)) / cosine_i);
    return value;
}

vec3 evaluate_lobe(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) { return lobe_value(lobe, n, wo, wi).bsdf; }

float lobe_pdf(MicrofacetLobe lobe, vec3 n, vec3 wo, vec3 wi) {
#ifdef HAIR_LOBES
    if (lobe.kind == LOBE_HAIR_HUANG) return HUANG_PDF;
#endif
    return lobe_value(lobe, n, wo, wi).pdf;
}
