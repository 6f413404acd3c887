// SPDX-License-Identifier: GPL-3.0-or-later
// Shaders of fibers as Cycles has them. On meshes fibers run along an edge of each triangle.

#include "common/bsdf/hair_color.glsl"
#include "materials/builder.glsl"
#include "materials/surface.glsl"

// Followed by the camera's paths, and evaluated toward lights: strands are too thin to store photons.
const float HAIR_ALPHA = 0.06;

// Along a strand, or from a triangle's first corner to the one of that number.
vec3 fiber_tangent(Surface surface, int corner, out bool on_strand) {
    on_strand = false;
#ifdef ROUND_SHAPES
    if (is_strand(surface)) {
        on_strand = true;
        return strand_at(surface).tangent;
    }
#endif
    if (surface.triangle == NO_TRIANGLE) return surface.normal.zxy;
    vec3 v0, v1, v2;
    triangle_points(surface.triangle, v0, v1, v2);
    return normalize((corner == 1 ? v1 : v2) - v0) * (surface.backfacing ? -1.0 : 1.0);
}

// Without a tangent given, meshes have no offset.
void node_bsdf_hair(Surface surface, inout ClosureBuilder builder, float weight, int component, vec3 color,
                    float offset, float roughness_u, float roughness_v, vec3 tangent) {
    bool on_strand, given = dot(tangent, tangent) > 1e-12;
    vec3 along = fiber_tangent(surface, 2, on_strand);
    if (given) along = normalize(tangent);
    vec3 shape = vec3(clamp(vec2(roughness_u, roughness_v), 0.001, 1.0), given || on_strand ? -offset : 0.0);
    add_lobe(builder,
             MicrofacetLobe(weight * max(color, 0.0), component == 0 ? LOBE_HAIR_REFLECTION : LOBE_HAIR_TRANSMISSION,
                            shape, HAIR_ALPHA, vec3(on_strand ? 1.0 : 0.0), 1.0, pack_unit_vector(builder.shading),
                            pack_unit_vector(along)));
}

// The tangent's angle about n and the offset, as common/bsdf/hair_chiang.glsl reads them.
uint pack_hair(vec3 n, vec3 tangent, float offset, bool on_strand) {
    vec3 t, b;
    tangent_frame(n, t, b);
    vec2 along = vec2(dot(tangent, t), dot(tangent, b));
    float turn = dot(along, along) > 0.0 ? fract(atan(along.y, along.x) / (2.0 * PI)) : 0.0;
    return (packUnorm2x16(vec2(turn, offset / PI + 0.5)) & ~HAIR_ON_STRAND) | (on_strand ? HAIR_ON_STRAND : 0u);
}

// Absorption over the radius of a fiber that has a color when many are seen together.
vec3 absorption_of_color(vec3 color, float radial_roughness) {
    vec3 root = log(max(color, 1e-6)) / hair_color_scale(radial_roughness);
    return root * root;
}

// parametrization: absorption, melanin, color. random: of the strand.
vec3 hair_absorption(int parametrization, vec3 color, float melanin, float redness, vec3 tint, vec3 absorption,
                     float radial_roughness, float random_color, float random) {
    if (parametrization == 0) return max(absorption, 0.0);
    if (parametrization == 2) return absorption_of_color(color, radial_roughness);
    melanin *= 1.0 + 2.0 * (random - 0.5) * clamp(random_color, 0.0, 1.0);
    melanin = -log(max(1.0 - melanin, 0.0001));
    vec3 pigments = mix(vec3(0.506, 0.841, 1.653), vec3(0.343, 0.733, 1.924), redness);
    return max(melanin * pigments, 0.0) + absorption_of_color(tint, radial_roughness);
}

// Half of what a pixel covers over the radius of a strand that the camera sees, at most 1: means are over that width.
// Elsewhere over all of it.
float pixel_over_radius(Surface surface) {
#ifdef ROUND_SHAPES
    if (is_strand(surface) && (surface.ray & RAY_CAMERA) != 0u) {
        float width = parameters.pixel_size * (parameters.orthographic != 0u ? 1.0 : surface.ray_length);
        return min(0.5 * width / max(strand_at(surface).radius, 1e-20), 1.0);
    }
#endif
    return 1.0;
}

// model: Chiang's, Huang's. strand_random: of a strand, in place of random; less than 0 where that is given.
void node_bsdf_hair_principled(Surface surface, inout ClosureBuilder builder, float weight, int model,
                               int parametrization, vec3 color, float melanin, float redness, vec3 tint,
                               vec3 absorption, float aspect_ratio, float roughness, float radial_roughness, float coat,
                               float ior, float offset, float random_color, float random_roughness, float random,
                               float r_lobe, float tt_lobe, float trt_lobe, float strand_random) {
    bool on_strand, huang = model == 1;
    vec3 tangent = fiber_tangent(surface, 1, on_strand), n = builder.geometric;
    if (on_strand && strand_random >= 0.0) random = strand_random;
    float randomness = 1.0 + 2.0 * (random - 0.5) * random_roughness;
    roughness *= randomness;
    radial_roughness *= randomness;
    vec3 sigma = hair_absorption(parametrization, color, melanin, redness, tint, absorption,
                                 huang ? roughness : radial_roughness, random_color, random);
    vec3 lobes = vec3(1.0), shape = vec3(radial_roughness, roughness, 1.0 - coat);
    if (huang) {
        float aspect = max(aspect_ratio, 0.05);
        lobes = max(vec3(r_lobe, tt_lobe, trt_lobe), 0.0);
        shape = vec3(min(aspect, 1.0 / aspect), roughness, pixel_over_radius(surface));
    }
    add_lobe(builder, MicrofacetLobe(weight * lobes, huang ? LOBE_HAIR_HUANG : LOBE_HAIR_CHIANG, sigma, HAIR_ALPHA,
                                     clamp(shape, 0.0, 1.0), max(ior, 1e-3), pack_unit_vector(n),
                                     pack_hair(n, tangent, offset, on_strand)));
}
