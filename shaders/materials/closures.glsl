// SPDX-License-Identifier: GPL-3.0-or-later
// From shader nodes to a closure, seen from one side: what Cycles' shader nodes set up.

#include "common/bsdf/closure.glsl"
#include "common/finite.glsl"
#include "materials/albedo_tables.glsl"

struct ClosureBuilder { Closure closure; int lobes; float cosine; bool backfacing; float u_choice; };

Closure empty_closure() {
    vec3 none = vec3(0.0);
    return Closure(none, NO_TRIANGLE, none, 0u, none, 0u, none, 0u, 0.0, 0u,
                   none, LOBE_NONE, none, 0.0, none, LOBE_NONE, none, 0.0, none, LOBE_NONE, none, 0.0, vec3(1.0), 0.0);
}

// Before any shader has been added; u_choice: a random number for lobes that do not fit in.
ClosureBuilder empty_builder(Surface surface, float u_choice) {
    return ClosureBuilder(empty_closure(), 0, clamp(dot(surface.normal, surface.viewer), 0.0, 1.0), surface.backfacing, u_choice);
}

void set_lobe(inout Closure closure, int slot, MicrofacetLobe lobe) {
    if (slot == 0) { closure.lobe0_weight = lobe.weight; closure.lobe0_kind = lobe.kind; closure.lobe0_f0 = lobe.f0; closure.lobe0_alpha = lobe.alpha; closure.lobe_ior.x = lobe.ior; }
    else if (slot == 1) { closure.lobe1_weight = lobe.weight; closure.lobe1_kind = lobe.kind; closure.lobe1_f0 = lobe.f0; closure.lobe1_alpha = lobe.alpha; closure.lobe_ior.y = lobe.ior; }
    else { closure.lobe2_weight = lobe.weight; closure.lobe2_kind = lobe.kind; closure.lobe2_f0 = lobe.f0; closure.lobe2_alpha = lobe.alpha; closure.lobe_ior.z = lobe.ior; }
}

// Rescale what a lobe scatters: glass keeps its tint of the passing light in f0.
void scale_lobe(inout MicrofacetLobe lobe, float factor) {
    lobe.weight *= factor;
    if (lobe.kind == LOBE_GLASS) lobe.f0 *= factor;
}

// A closure holds three lobes; of the third and any further one, one is chosen by its albedo and
// stands for both, which leaves the mean as it is.
void add_lobe(inout ClosureBuilder builder, MicrofacetLobe lobe) {
    float brightness = largest(lobe_albedo(lobe, builder.cosine));
    if (brightness <= 0.0 && largest(lobe.weight) <= 0.0) return;
    if (builder.lobes < CLOSURE_LOBES) {
        set_lobe(builder.closure, builder.lobes, lobe);
        builder.lobes += 1;
        return;
    }
    MicrofacetLobe held = closure_lobe(builder.closure, CLOSURE_LOBES - 1);
    float held_brightness = largest(lobe_albedo(held, builder.cosine));
    float probability = brightness / max(brightness + held_brightness, 1e-20);
    if (builder.u_choice < probability) {
        builder.u_choice /= probability;
        scale_lobe(lobe, 1.0 / probability);
        set_lobe(builder.closure, CLOSURE_LOBES - 1, lobe);
    } else {
        builder.u_choice = (builder.u_choice - probability) / (1.0 - probability);
        scale_lobe(held, 1.0 / (1.0 - probability));
        set_lobe(builder.closure, CLOSURE_LOBES - 1, held);
    }
}

// What restores the energy that single scattering loses, given the average reflectance of the
// microfacets (Kulla and Conty 2017, with the saturation of multiple bounces).
vec3 multiscatter_factor(float roughness, float cosine, vec3 average_reflectance) {
    float albedo = white_albedo(roughness, cosine), average = white_average_albedo(roughness);
    float missing = (1.0 - albedo) / albedo;
    vec3 multiple = average_reflectance * average / (1.0 - average_reflectance * (1.0 - average));
    return 1.0 + multiple * missing;
}

void add_mirror(inout ClosureBuilder builder, float weight, vec3 color, float roughness, bool multiscatter) {
    vec3 factor = multiscatter ? multiscatter_factor(roughness, builder.cosine, color) : vec3(1.0);
    add_lobe(builder, MicrofacetLobe(weight * color * factor, LOBE_MIRROR, vec3(1.0), roughness * roughness, 1.0));
}

void add_glass(inout ClosureBuilder builder, vec3 reflected, vec3 passed, float roughness, float ior, bool multiscatter) {
    float relative = builder.backfacing ? 1.0 / ior : ior;
    if (multiscatter) {
        float factor = 1.0 / max(glass_albedo(relative, roughness, builder.cosine), 0.05);
        reflected *= factor;
        passed *= factor;
    }
    add_lobe(builder, MicrofacetLobe(reflected, LOBE_GLASS, passed, roughness * roughness, relative));
}

float index_from_reflectance(float f0) {
    float root = sqrt(clamp(f0, 0.0, 0.99));
    return (1.0 + root) / (1.0 - root);
}

// Numbers from a node graph may be anything; what they make of light stays finite. Weights beyond the limit would
// overflow within a path.
const float LARGEST_WEIGHT = 1e3, LARGEST_EMISSION = 1e12;

vec3 usable(vec3 value, float limit) { return is_finite(value) ? clamp(value, 0.0, limit) : vec3(0.0); }

float usable(float value, float low, float high) { return is_finite(vec3(value)) ? clamp(value, low, high) : low; }

void make_usable(inout Closure closure) {
    closure.emission = usable(closure.emission, LARGEST_EMISSION);
    closure.diffuse = usable(closure.diffuse, LARGEST_WEIGHT);
    closure.transparent = usable(closure.transparent, LARGEST_WEIGHT);
    closure.lobe0_weight = usable(closure.lobe0_weight, LARGEST_WEIGHT);
    closure.lobe1_weight = usable(closure.lobe1_weight, LARGEST_WEIGHT);
    closure.lobe2_weight = usable(closure.lobe2_weight, LARGEST_WEIGHT);
    closure.lobe0_f0 = usable(closure.lobe0_f0, LARGEST_WEIGHT);
    closure.lobe1_f0 = usable(closure.lobe1_f0, LARGEST_WEIGHT);
    closure.lobe2_f0 = usable(closure.lobe2_f0, LARGEST_WEIGHT);
    closure.lobe0_alpha = usable(closure.lobe0_alpha, 0.0, 1.0);
    closure.lobe1_alpha = usable(closure.lobe1_alpha, 0.0, 1.0);
    closure.lobe2_alpha = usable(closure.lobe2_alpha, 0.0, 1.0);
    closure.lobe_ior = vec3(usable(closure.lobe_ior.x, 1e-5, 1e5), usable(closure.lobe_ior.y, 1e-5, 1e5), usable(closure.lobe_ior.z, 1e-5, 1e5));
}
