// SPDX-License-Identifier: GPL-3.0-or-later
// Shader nodes as Cycles has them. What stands in for something else says so.

#include "materials/principled.glsl"

float unit(float value) { return clamp(value, 0.0, 1.0); }
float valid_ior(float ior) { return clamp(ior, 1e-3, 1e3); }

void node_bsdf_diffuse(inout ClosureBuilder builder, float weight, vec3 color, float roughness, vec3 normal) {
    add_diffuse(builder, vec3(weight), max(color, 0.0), unit(roughness), normal);
}

void node_bsdf_translucent(inout ClosureBuilder builder, float weight, vec3 color, vec3 normal) {
    add_diffuse_parts(builder, vec3(0.0), weight * max(color, 0.0), reflecting_normal(builder, normal), 0u);
}

void node_bsdf_transparent(inout ClosureBuilder builder, float weight, vec3 color) {
    builder.closure.transparent += weight * max(color, 0.0);
}

void node_emission(inout ClosureBuilder builder, float weight, vec3 color, float strength) {
    builder.closure.emission += weight * color * strength;
}

void node_background(inout ClosureBuilder builder, float weight, vec3 color, float strength) {
    node_emission(builder, weight, color, strength);
}

void node_holdout(inout ClosureBuilder builder, float weight) { add_holdout(builder, weight); }

// Anisotropy from -0.99 to 0.99: above 0 the tangent's axis is the smoother one.
Microfacets stretched_microfacets(ClosureBuilder builder, vec3 normal, float roughness, float anisotropy, vec3 tangent,
                                  float rotation) {
    anisotropy = clamp(anisotropy, -0.99, 0.99);
    float aspect = anisotropy < 0.0 ? 1.0 + anisotropy : 1.0 / (1.0 - anisotropy);
    return anisotropic_microfacets(builder, normal, unit(roughness), aspect, tangent, rotation);
}

void node_bsdf_glossy(inout ClosureBuilder builder, float weight, int distribution, vec3 color, float roughness,
                      float anisotropy, float rotation, vec3 normal, vec3 tangent) {
    Microfacets at = stretched_microfacets(builder, normal, roughness, anisotropy, tangent, rotation);
    if (distribution == 0) at.anisotropy |= BECKMANN;
    if (distribution == 2) add_phong_mirror(builder, at, weight, max(color, 0.0));
    else add_mirror(builder, at, weight, max(color, 0.0), distribution == 3);
}

void node_bsdf_glass(inout ClosureBuilder builder, float weight, int distribution, vec3 color, float roughness,
                     float ior, vec3 normal, float thin_film_thickness, float thin_film_ior) {
    vec3 weighted = weight * max(color, 0.0);
    Microfacets at = isotropic_microfacets(builder, normal, unit(roughness));
    if (distribution == 0) at.anisotropy |= BECKMANN;
    Film film = Film(thin_film_thickness, max(thin_film_ior, 1e-3));
    float relative = relative_ior(builder, valid_ior(ior));
    MicrofacetLobe lobe =
        glass_lobe(at, weighted, weighted, vec3(1.0), clamp(color, 0.0, 1.0), relative, distribution == 2);
    add_lobe(builder, covered_glass_lobe(builder, lobe, film, valid_ior(ior), vec3(1.0)));
}

void node_bsdf_refraction(inout ClosureBuilder builder, float weight, int distribution, vec3 color, float roughness,
                          float ior, vec3 normal) {
    Microfacets at = isotropic_microfacets(builder, normal, unit(roughness));
    if (distribution == 0) at.anisotropy |= BECKMANN;
    add_refraction(builder, at, weight * max(color, 0.0), valid_ior(ior));
}

void node_bsdf_sheen(inout ClosureBuilder builder, float weight, int distribution, vec3 color, float roughness,
                     vec3 normal) {
    vec3 weighted = weight * max(color, 0.0);
    float albedo;
    MicrofacetLobe lobe = distribution == 0 ? velvet_lobe(builder, weighted, unit(roughness), normal)
                                            : sheen_lobe(builder, weighted, unit(roughness), normal, albedo);
    if (lobe.kind != LOBE_NONE) add_lobe(builder, lobe);
}

#ifdef MATERIAL_SUBSURFACE
void node_subsurface_scattering(inout ClosureBuilder builder, float weight, int falloff, vec3 color, float scale,
                                vec3 radius, float ior, float roughness, float anisotropy, vec3 normal) {
    add_subsurface(builder, vec3(weight), clamp(color, 0.0, 1.0), max(radius * scale, 0.0), ior, unit(roughness),
                   anisotropy, uint(falloff), normal);
}
#endif

#ifdef MATERIAL_RAY_PORTAL
void node_bsdf_ray_portal(inout ClosureBuilder builder, float weight, vec3 color, vec3 position, vec3 direction) {
    add_ray_portal(builder, weight * max(color, 0.0), position, direction);
}
#endif

vec3 conductor_reflectance(float cosine, vec3 n, vec3 k) {
    float c2 = cosine * cosine, s2 = 1.0 - c2;
    vec3 d = n * n - k * k - s2;
    vec3 root = sqrt(d * d + 4.0 * n * n * k * k), a = sqrt(max(0.5 * (root + d), 0.0));
    vec3 perpendicular = (root + c2 - 2.0 * a * cosine) / (root + c2 + 2.0 * a * cosine);
    vec3 both = (c2 * root + s2 * s2 - 2.0 * a * cosine * s2) / (c2 * root + s2 * s2 + 2.0 * a * cosine * s2);
    return 0.5 * perpendicular * (1.0 + both);
}

// Of a physical conductor, the F82 curve that meets its own at normal incidence and at 82 degrees.
void node_bsdf_metallic(inout ClosureBuilder builder, float weight, int distribution, int fresnel_type, vec3 base_color,
                        vec3 edge_tint, vec3 ior, vec3 extinction, float roughness, float anisotropy, float rotation,
                        vec3 normal, vec3 tangent, float thin_film_thickness, float thin_film_ior) {
    Microfacets at = anisotropic_microfacets(builder, normal, unit(roughness), sqrt(1.0 - 0.9 * unit(anisotropy)),
                                             tangent, rotation);
    if (distribution == 0) at.anisotropy |= BECKMANN;
    vec3 f0 = clamp(base_color, 0.0, 1.0), edge = clamp(edge_tint, 0.0, 1.0);
    if (fresnel_type == 0) {
        const float cosine = 1.0 / 7.0;
        vec3 n = max(ior, 0.0), k = max(extinction, 0.0);
        f0 = clamp(conductor_reflectance(1.0, n, k), 0.0, 1.0);
        edge = clamp(conductor_reflectance(cosine, n, k) / mix(f0, vec3(1.0), schlick_interpolation(cosine)), 0.0, 1.0);
    }
    Film film = Film(thin_film_thickness, max(thin_film_ior, 1e-3));
    MicrofacetLobe lobe = metal_lobe(at, vec3(weight), f0, edge, distribution == 2, white_albedos(at));
    if (film.thickness > THINNEST_FILM) {
        vec3 n = max(ior, 0.0);
        if (fresnel_type == 0) lobe.tint = n / (1.0 + n);
        lobe = covered_lobe(lobe, film, fresnel_type != 0);
    }
    add_lobe(builder, lobe);
}

void node_bsdf_toon(inout ClosureBuilder builder, float weight, int component, vec3 color, float size, float smoothness,
                    vec3 normal) {
    add_lobe(builder, toon_lobe(builder, component == 0 ? LOBE_TOON : LOBE_GLOSSY_TOON, weight * max(color, 0.0), size,
                                smoothness, normal));
}

void node_bsdf_principled(inout ClosureBuilder builder, float weight, int distribution, int subsurface_method,
                          int thin_wall, vec3 base_color, float metallic, float roughness, float ior, float alpha,
                          vec3 normal, float diffuse_roughness, float subsurface_weight, vec3 subsurface_radius,
                          float subsurface_scale, float subsurface_ior, float subsurface_anisotropy,
                          float specular_ior_level, vec3 specular_tint, float anisotropic, float anisotropic_rotation,
                          vec3 tangent, float transmission_weight, float coat_weight, float coat_roughness,
                          float coat_ior, vec3 coat_tint, vec3 coat_normal, float sheen_weight, float sheen_roughness,
                          vec3 sheen_tint, vec3 emission_color, float emission_strength, float thin_film_thickness,
                          float thin_film_ior) {
    add_principled(
        builder, weight,
        Principled(max(base_color, 0.0), unit(metallic), unit(roughness), valid_ior(ior), unit(alpha), normal,
                   unit(diffuse_roughness), unit(subsurface_weight), max(subsurface_radius * subsurface_scale, 0.0),
                   subsurface_ior, subsurface_anisotropy, uint(subsurface_method), max(specular_ior_level, 0.0),
                   max(specular_tint, 0.0), unit(anisotropic), anisotropic_rotation, tangent, unit(transmission_weight),
                   unit(coat_weight), unit(coat_roughness), max(coat_ior, 1.0), max(coat_tint, 0.0), coat_normal,
                   unit(sheen_weight), unit(sheen_roughness), max(sheen_tint, 0.0),
                   emission_color * max(emission_strength, 0.0),
                   Film(max(thin_film_thickness, 0.0), max(thin_film_ior, 1e-3)), distribution == 1, thin_wall == 1));
}
