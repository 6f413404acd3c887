// SPDX-License-Identifier: GPL-3.0-or-later
// Albedos of a surface by what its lobes do, over which the light that they scatter is handed out: those of Cycles.

#include "materials/albedo_tables.glsl"

// Where a lobe scatters any light, its color must be none to divide by 0.
const float MIN_REFLECTANCE = 1e-6;

struct LightColors {
    vec3 diffuse;
    vec3 glossy;
    vec3 transmission;
};

vec3 not_nothing(vec3 reflectance) { return max(reflectance, vec3(MIN_REFLECTANCE)); }

#ifdef HAIR_LOBES
#include "common/bsdf/hair_color.glsl"

// Of Chiang's model about that of many fibers, as Cycles has it by the variance, and what their coats reflect.
vec3 hair_color(MicrofacetLobe lobe, float cosine) {
    if (lobe.kind != LOBE_HAIR_CHIANG) return hair_albedo(lobe, cosine);
    float scale = hair_color_scale(hair_variance(clamp(lobe.tint.y, 0.001, 1.0)));
    return lobe.weight * (exp(-sqrt(lobe.f0) * scale) + fresnel_dielectric(cosine, lobe.ior));
}
#endif

// Energy that single scattering loses is in the weights of those that restore it.
void add_lobe_color(inout LightColors colors, MicrofacetLobe lobe, vec3 viewer) {
    float cosine = lobe_cosine(lobe, viewer), roughness = sqrt(lobe.alpha);
    uint kind = lobe.kind;
    vec3 reflectance = facet_fresnel(lobe, cosine).reflectance;
#ifdef HAIR_LOBES
    if (kind == LOBE_HAIR_TRANSMISSION) colors.transmission += lobe.weight;
    else if (lobe_is_hair(kind)) colors.glossy += hair_color(lobe, cosine);
    else
#endif
        if (lobe_is_diffuse(kind))
        colors.diffuse += lobe.weight * reflectance;
    else if (!lobe_has_facets(kind)) colors.glossy += lobe.weight * reflectance;
    else if (kind == LOBE_REFRACTION) colors.transmission += lobe.weight;
    else if (kind == LOBE_SHEET) colors.transmission += lobe.weight * white_albedo(roughness, cosine);
#ifdef ASHIKHMIN_LOBES
    else if (lobe_is_ashikhmin(lobe)) colors.glossy += lobe.weight;
#endif
    else if (kind == LOBE_MIRROR || kind == LOBE_METAL)
        colors.glossy += lobe.weight * not_nothing(reflectance) * white_albedo(roughness, cosine);
    else {
        float white = white_albedo(roughness, cosine);
        float rise = lobe.ior > 1.0 ? dielectric_interpolation_of_facets(lobe.ior, roughness, cosine)
                                    : dielectric_interpolation(cosine, lobe.ior);
        vec3 f0 = kind == LOBE_DIELECTRIC ? lobe.f0 : lobe.tint * normal_reflectance(lobe.ior);
        float energy = kind == LOBE_DIELECTRIC ? white : max(glass_albedo(lobe.ior, roughness, cosine), 0.05);
        vec3 glossy = mix(f0, vec3(1.0), rise);
#ifdef THIN_FILM_LOBES
        if (lobe_has_film(lobe)) glossy = reflectance;
#endif
        colors.glossy += lobe.weight * energy * not_nothing(glossy);
        if (lobe_transmits(kind)) colors.transmission += lobe.f0 * energy * not_nothing(1.0 - reflectance);
    }
}

LightColors light_colors(uint path, Closure closure, vec3 viewer) {
    LightColors colors = LightColors(closure.diffuse + closure.translucent, vec3(0.0), vec3(0.0));
    for (int k = 0; k < closure_lobes(closure); ++k) {
        MicrofacetLobe lobe = stored_lobe(path, k);
        if (lobe.kind != LOBE_NONE) add_lobe_color(colors, lobe, viewer);
    }
    return colors;
}
