// SPDX-License-Identifier: GPL-3.0-or-later
// Shader nodes.

#include "materials/closures.glsl"

void node_bsdf_diffuse(inout ClosureBuilder builder, float weight, vec3 color) { builder.closure.diffuse += weight * max(color, 0.0); }

void node_bsdf_glossy(inout ClosureBuilder builder, float weight, int distribution, vec3 color, float roughness) {
    add_mirror(builder, weight, max(color, 0.0), clamp(roughness, 0.0, 1.0), distribution == 3);
}

void node_bsdf_glass(inout ClosureBuilder builder, float weight, int distribution, vec3 color, float roughness, float ior) {
    vec3 weighted = weight * max(color, 0.0);
    add_glass(builder, weighted, weighted, clamp(roughness, 0.0, 1.0), max(ior, 1e-5), distribution == 2);
}

void node_bsdf_refraction(inout ClosureBuilder builder, float weight, vec3 color, float roughness, float ior) {
    roughness = clamp(roughness, 0.0, 1.0);
    ior = max(ior, 1e-5);
    add_lobe(builder, MicrofacetLobe(weight * max(color, 0.0), LOBE_REFRACTION, vec3(0.0), roughness * roughness,
                                     builder.backfacing ? 1.0 / ior : ior));
}

void node_bsdf_transparent(inout ClosureBuilder builder, float weight, vec3 color) { builder.closure.transparent += weight * max(color, 0.0); }

void node_emission(inout ClosureBuilder builder, float weight, vec3 color, float strength) {
    builder.closure.emission += weight * max(color * strength, 0.0);
}

void node_background(inout ClosureBuilder builder, float weight, vec3 color, float strength) { node_emission(builder, weight, color, strength); }

void node_bsdf_principled(inout ClosureBuilder builder, float weight, int distribution, vec3 color, float metallic, float roughness,
                          float ior, float alpha, float specular_ior_level, vec3 specular_tint, float transmission,
                          vec3 emission_color, float emission_strength) {
    color = max(color, 0.0);
    specular_tint = max(specular_tint, 0.0);
    roughness = clamp(roughness, 0.0, 1.0);
    metallic = clamp(metallic, 0.0, 1.0);
    transmission = clamp(transmission, 0.0, 1.0);
    alpha = clamp(alpha, 0.0, 1.0);
    ior = max(ior, 1e-5);
    bool multiscatter = distribution == 1;
    float cosine = builder.cosine;
    builder.closure.transparent += vec3(weight * (1.0 - alpha));
    weight *= alpha;
    builder.closure.emission += weight * max(emission_color * emission_strength, 0.0);
    if (metallic > 0.0) {
        vec3 average = mix(color, vec3(1.0), 1.0 / 21.0);  // cosine-weighted mean of Schlick's Fresnel
        vec3 factor = multiscatter ? multiscatter_factor(roughness, cosine, average) : vec3(1.0);
        add_lobe(builder, MicrofacetLobe(weight * metallic * factor, LOBE_METAL, color, roughness * roughness, 1.0));
        weight *= 1.0 - metallic;
    }
    if (transmission > 0.0) {
        float share = weight * transmission;
        add_glass(builder, share * specular_tint, share * sqrt(color), roughness, ior, multiscatter);
        weight *= 1.0 - transmission;
    }
    if (weight <= 0.0) return;
    float f0 = normal_reflectance(ior) * 2.0 * max(specular_ior_level, 0.0);
    float adjusted = index_from_reflectance(f0);
    vec3 below = vec3(weight);
    if (f0 > 0.0) {
        vec3 tinted = min(f0 * specular_tint, vec3(1.0));
        float outside = max(adjusted, 1.0 / adjusted);
        // Cycles does not compensate this lobe: what it loses passes to the layer below.
        vec3 albedo = tinted * white_albedo(roughness, cosine)
                    + (1.0 - tinted) * dielectric_grazing_albedo(outside, roughness, cosine);
        add_lobe(builder, MicrofacetLobe(vec3(weight), LOBE_DIELECTRIC, tinted, roughness * roughness, outside));
        below *= 1.0 - largest(albedo);
    }
    builder.closure.diffuse += max(below, vec3(0.0)) * color;
}

void node_volume_absorption(inout ClosureBuilder builder, float weight, vec3 color, float density) {
    builder.closure.emission += weight * max(density, 0.0) * (1.0 - clamp(color, 0.0, 1.0));
}
