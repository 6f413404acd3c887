// SPDX-License-Identifier: GPL-3.0-or-later
// Subsurface scattering. Before the nodes of a material that has it (rppm_addon/materials/traits/subsurface.py).

#include "materials/builder.glsl"
#include "common/bsdf/subsurface.glsl"
#define MATERIAL_SUBSURFACE

// What nodes have added so far, and what the closure gets when all have.
Subsurface material_subsurface = NO_SUBSURFACE;

// Shorter ones are no way below the surface, meters.
const float SHORTEST_RADIUS = 1e-8;

// The albedo of single scattering by which a dipole of the index reflects so much (Jensen et al. 2001, eq. 15), less
// than 1. a: 4/3 (1 + F) / (1 - F), of the surface's mean reflectance F from within. Bright colors' mean free paths
// depend on where the halving stops: here as in Cycles, at the last one that was tried.
vec3 dipole_albedo(vec3 reflected, float a) {
    vec3 low = vec3(0.0), high = vec3(1.0), middle;
    for (int k = 0; k < 12; ++k) {
        middle = 0.5 * (low + high);
        vec3 s = sqrt(3.0 * (1.0 - middle));
        bvec3 less = lessThan(0.5 * middle * (1.0 + exp(-a * s)) * exp(-s), reflected);
        low = mix(low, middle, less);
        high = mix(middle, high, less);
    }
    vec3 albedo = mix(middle, vec3(0.0), lessThan(reflected, vec3(1e-4)));
    return mix(albedo, vec3(0.999999), greaterThanEqual(reflected, vec3(0.995)));
}

// Mean free paths, as in Cycles: the radius, or of skin that by which a dipole has it, else such as look like those of
// older models.
vec3 mean_free_path(vec3 radius, vec3 albedo, float ior, uint method) {
    if (method == SUBSURFACE_RANDOM_WALK) return radius;
    if (method != SUBSURFACE_RANDOM_WALK_SKIN) return radius * (0.25 / PI);
    float eta = 1.0 / ior, reflected = eta * (0.710 - 1.440 * eta) + 0.668 + 0.0636 * ior;
    return radius * sqrt(3.0 * (1.0 - dipole_albedo(albedo, 4.0 / 3.0 * (1.0 + reflected) / (1.0 - reflected))));
}

// Of several, one is chosen by its albedo and stands for all.
void add_subsurface(inout ClosureBuilder builder, vec3 weight, vec3 albedo, vec3 radius, float ior, float alpha,
                    float anisotropy, uint method, vec3 normal) {
    vec3 scattered = weight * albedo;
    bvec3 is_short = lessThan(radius, vec3(SHORTEST_RADIUS));
    add_diffuse_parts(builder, mix(vec3(0.0), scattered, is_short), vec3(0.0), normal, 0u);
    scattered = mix(scattered, vec3(0.0), is_short);
    float brightness = largest(scattered), held = largest(material_subsurface.weight);
    if (!(brightness > 0.0)) return;
    float probability = brightness / (brightness + held);
    if (!chance(builder, probability)) {
        material_subsurface.weight /= 1.0 - probability;
        return;
    }
    ior = clamp(ior, 1.01, 3.8);
    bool is_rough = method == SUBSURFACE_RANDOM_WALK_SKIN || method == SUBSURFACE_BURLEY;
    material_subsurface =
        Subsurface(scattered / probability, albedo, mean_free_path(radius, albedo, ior, method),
                   clamp(anisotropy, -0.99, method == SUBSURFACE_RANDOM_WALK ? 0.99 : 0.9), ior, is_rough ? 1.0 : alpha,
                   method, pack_unit_vector(reflecting_normal(builder, normal)));
}

// A closure of three lobes has no place for it: then it or the last lobe is chosen by its albedo.
void hold_subsurface(inout ClosureBuilder builder) {
    Subsurface part = material_subsurface;
    float brightness = largest(part.weight);
    if (!(brightness > 0.0)) return;
    if (builder.lobes == CLOSURE_LOBES) {
        MicrofacetLobe last = last_lobe(builder.closure);
        float others = largest(lobe_albedo(last, lobe_cosine(last, builder.viewer)));
        float probability = brightness / (brightness + others);
        if (!chance(builder, probability)) {
            scale_lobe(last, 1.0 / (1.0 - probability));
            hold_lobe(builder, CLOSURE_LOBES - 1, last);
            return;
        }
        part.weight /= probability;
        builder.lobes -= 1;
    }
    builder.closure.lobes[CLOSURE_LOBES - 1] = packed_subsurface(part);
    builder.closure.flags |= CLOSURE_SUBSURFACE;
    if (largest(builder.closure.diffuse) <= 0.0 && largest(builder.closure.translucent) <= 0.0) {
        builder.closure.diffuse_normal = part.normal;
        builder.closure.diffuse_roughness = 0u;
    }
    builder.closure.diffuse += part.weight;
}
