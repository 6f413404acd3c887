// SPDX-License-Identifier: GPL-3.0-or-later
// The Principled BSDF's layers, from the top: sheen, coat, emission, then metal, transmission and a dielectric over
// a diffuse base; as a thin wall the same on both sides of a sheet. A layer takes the light that its albedo says and
// leaves the rest to those below.

#include "materials/thin_wall.glsl"

struct Principled {
    vec3 base_color;
    float metallic, roughness, ior, alpha;
    vec3 normal;
    float diffuse_roughness, subsurface;
    vec3 subsurface_radius;
    float subsurface_ior, subsurface_anisotropy;
    uint subsurface_method;
    float specular_level;
    vec3 specular_tint;
    float anisotropic, anisotropic_rotation;
    vec3 tangent;
    float transmission, coat, coat_roughness, coat_ior;
    vec3 coat_tint, coat_normal;
    float sheen, sheen_roughness;
    vec3 sheen_tint, emission;
    Film film;
    bool multiscatter, thin_wall;
};

float index_from_reflectance(float f0) {
    float root = sqrt(clamp(f0, 0.0, 0.99));
    return (1.0 + root) / (1.0 - root);
}

// Light left below a layer.
vec3 beneath(vec3 weight, vec3 albedo) { return weight * clamp(1.0 - largest(albedo), 0.0, 1.0); }

// Albedo of microfacets that reflect f0 at normal incidence, had they no energy to lose.
vec3 dielectric_albedo(float ior, float roughness, float cosine, vec3 f0) {
    return mix(f0, vec3(1.0), dielectric_interpolation_of_facets(ior, roughness, cosine));
}

MicrofacetLobe coat_lobe(ClosureBuilder builder, Principled p, inout vec3 weight) {
    float ior = max(p.coat_ior, 1.0);
    Microfacets at = isotropic_microfacets(builder, p.coat_normal, p.coat_roughness);
    float f0 = normal_reflectance(ior);
    MicrofacetLobe lobe = NO_LOBE;
    if (ior > 1.0) {
        vec2 whites = white_albedos(at);
        vec3 factor = multiscatter_factor(whites, vec3(average_reflectance(ior)));
        lobe = microfacet_lobe(at, LOBE_DIELECTRIC, weight * p.coat * factor, vec3(f0), vec3(1.0), ior);
        vec3 albedo = factor * whites.x * dielectric_albedo(ior, p.coat_roughness, at.cosine, vec3(f0));
        if (!builder.is_bare) weight = beneath(weight, p.coat * albedo);
    }
    // Absorbed along the refracted way through the coat, which is of length 1 at normal incidence.
    float inside = sqrt(max(1.0 - (1.0 - at.cosine * at.cosine) / (ior * ior), 1e-6));
    weight *= mix(vec3(1.0), pow(p.coat_tint, vec3(1.0 / inside)), p.coat);
    return lobe;
}

// As in Cycles the index is the same from both sides.
float specular_ior(Principled p, out float f0) {
    f0 = normal_reflectance(p.ior) * 2.0 * p.specular_level;
    float ior = index_from_reflectance(f0);
    return p.ior < 1.0 ? 1.0 / ior : ior;
}

MicrofacetLobe base_lobe(Principled p, Microfacets at, vec2 whites, float f0, float ior, inout vec3 weight) {
    bool film = p.film.thickness > THINNEST_FILM;
    if (f0 <= 0.0 && !film) return NO_LOBE;
    vec3 tinted = min(f0 * p.specular_tint, vec3(1.0));
    vec3 factor = vec3(1.0), albedo = dielectric_albedo(max(ior, 1.0 / ior), p.roughness, at.cosine, tinted);
    if (film) {
        // As in Cycles, by the angle of the viewer to the normal.
        vec3 reflectance = thin_film_reflectance(at.cosine, p.film.thickness, 1.0, p.film.ior, ior, NO_METAL);
        albedo = scaled_film(reflectance, tinted, ior);
    }
    if (p.multiscatter) {
        float base = normal_reflectance(ior);
        factor = multiscatter_factor(whites, mix(tinted, vec3(1.0), (average_reflectance(ior) - base) / (1.0 - base)));
        albedo *= factor * whites.x;
    }
    MicrofacetLobe lobe = microfacet_lobe(at, LOBE_DIELECTRIC, weight * factor, tinted, vec3(1.0), ior);
    if (film) lobe = covered_lobe(lobe, p.film, false);
    weight = beneath(weight, albedo);
    return lobe;
}

// ior: of the surface of the base.
void add_base(inout ClosureBuilder builder, Principled p, float ior, vec3 weight) {
    if (p.thin_wall && p.subsurface > 0.0) {
        vec3 scattered = weight * p.subsurface * min(p.base_color, 1.0);
        add_thin_subsurface(builder, scattered, weight * (1.0 - p.subsurface) * p.base_color, p.subsurface_anisotropy,
                            p.normal, pack_diffuse_roughness(p.base_color, p.diffuse_roughness));
        return;
    }
#ifdef MATERIAL_SUBSURFACE
    if (p.subsurface > 0.0) {
        bool skin = p.subsurface_method == SUBSURFACE_RANDOM_WALK_SKIN;
        add_subsurface(builder, weight * p.subsurface, min(p.base_color, 1.0), p.subsurface_radius,
                       skin ? p.subsurface_ior : ior, p.roughness * p.roughness, p.subsurface_anisotropy,
                       p.subsurface_method, p.normal);
        weight *= 1.0 - p.subsurface;
    }
#endif
    add_diffuse(builder, weight, p.base_color, p.diffuse_roughness, p.normal);
}

#ifdef READS_TEXELS
#define LAYER_IS_DONE(lobe)
#else
#define LAYER_IS_DONE(lobe) \
    if (lobe.kind != LOBE_NONE && node_weight > 0.0) add_lobe(builder, lobe);
#endif

void add_principled(inout ClosureBuilder builder, float node_weight, Principled p) {
    // From the top; they are added together in one place, as drivers without calls have that code as often as it is
    // called.
    MicrofacetLobe sheen = NO_LOBE, coat = NO_LOBE, metal = NO_LOBE, glass = NO_LOBE, sheet = NO_LOBE, base = NO_LOBE;
    builder.closure.transparent += vec3(node_weight * (1.0 - p.alpha));
    vec3 weight = vec3(node_weight * p.alpha);
    if (p.sheen > 0.0) {
        vec3 normal =
            mix(given_normal(builder, p.normal), given_normal(builder, p.coat_normal), clamp(p.coat, 0.0, 1.0));
        vec3 tint = p.sheen * p.sheen_tint;
        float albedo;
        sheen = sheen_lobe(builder, weight * tint, p.sheen_roughness, normal, albedo);
        weight = beneath(weight, tint * albedo);
    }
    LAYER_IS_DONE(sheen)
    if (p.coat > 0.0) coat = coat_lobe(builder, p, weight);
    LAYER_IS_DONE(coat)
    builder.closure.emission += weight * p.emission;

    Microfacets at = anisotropic_microfacets(builder, p.normal, p.roughness, sqrt(1.0 - 0.9 * p.anisotropic), p.tangent,
                                             p.anisotropic_rotation);
    bool film = p.film.thickness > THINNEST_FILM;
    float f0, ior = specular_ior(p, f0);
    vec2 whites = white_albedos(at);
    if (p.metallic > 0.0) {
        metal = metal_lobe(at, weight * p.metallic, min(p.base_color, 1.0), min(p.specular_tint, 1.0), p.multiscatter,
                           whites);
        if (film) metal = covered_lobe(metal, p.film, true);
        weight *= 1.0 - p.metallic;
    }
    LAYER_IS_DONE(metal)
    if (p.transmission > 0.0) {
        vec3 glass_weight = weight * p.transmission, refracted_color = sqrt(max(p.base_color, vec3(0.0)));
        Microfacets even = Microfacets(at.normal, at.packed_normal, ISOTROPIC, p.roughness * p.roughness, at.cosine);
        float relative = relative_ior(builder, p.ior);
        if (p.thin_wall)
            thin_glass_lobes(builder, even, glass_weight, min(p.base_color, 1.0), p.specular_tint, p.film, p.ior, glass,
                             sheet);
        else {
            glass = glass_lobe(even, glass_weight, glass_weight * refracted_color, p.specular_tint,
                               min(refracted_color, 1.0), relative, p.multiscatter);
            glass = covered_glass_lobe(builder, glass, p.film, p.ior, p.specular_tint);
        }
        weight *= 1.0 - p.transmission;
    }
    LAYER_IS_DONE(glass)
    LAYER_IS_DONE(sheet)
    bool reaches_base = !(largest(weight) <= 0.0);
    vec3 below = weight;
    if (reaches_base) base = base_lobe(p, at, whites, f0, ior, below);
    LAYER_IS_DONE(base)
#ifdef READS_TEXELS
    int layers = node_weight > 0.0 ? 6 : 0;
    for (int k = 0; k < layers; ++k) {
        MicrofacetLobe lobe = k == 0 ? sheen : k == 1 ? coat : k == 2 ? metal : k == 3 ? glass : k == 4 ? sheet : base;
        if (lobe.kind != LOBE_NONE) add_lobe(builder, lobe);
    }
#endif
    if (reaches_base) add_base(builder, p, ior, builder.is_bare ? weight : below);
}
