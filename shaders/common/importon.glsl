// SPDX-License-Identifier: GPL-3.0-or-later
// The includer declares the storage blocks of photons[] and importons[] before, and the members photon_count,
// world_photon_flux and most_scattered of its parameters.
#include "common/bsdf/microfacet.glsl"
#include "common/sampling.glsl"
#include "common/gathering.glsl"
#include "common/world_caustics.glsl"
layout(std430, binding = 6) readonly buffer WorldRadiances { float world_radiances[]; };

// Flux arrived by the geometric cosine; a part of the BSDF asks for that of its own normal.
float shading_correction(float cosine, float geometric_cosine) { return min(abs(cosine) / max(geometric_cosine, 1e-5), 4.0); }

// BSDF times path throughput of an importon for a photon from wi, in front or behind; geometric_cosine: by which
// the photon arrived.
vec3 evaluate_importon(Importon importon, vec3 wi, bool front, float geometric_cosine) {
    vec3 normal = unpack_unit_vector(importon.diffuse_normal);
    float cosine = dot(normal, wi);
    vec3 value = vec3(0.0);
    if ((cosine > 0.0) == front) {
        value = (front ? importon.diffuse : importon.translucent)
              * rough_diffuse_factor(importon.diffuse_roughness, normal, importon.direction, wi);
        value *= bump_shadowing(unpack_unit_vector(importon.shading_normal), normal, wi) * shading_correction(cosine, geometric_cosine);
    }
    uint kind = unpack_kind(importon.lobe_kind);
    if (kind != LOBE_NONE) {
        normal = unpack_unit_vector(importon.lobe_normal);
        cosine = dot(normal, wi);
        MicrofacetLobe lobe = MicrofacetLobe(importon.lobe_weight, kind, importon.lobe_f0, importon.lobe_alpha, unpack_tint(importon.lobe_kind),
                                             importon.lobe_ior, importon.lobe_normal, importon.lobe_anisotropy);
        if ((cosine > 0.0) == front)
            value += evaluate_lobe(lobe, normal, importon.direction, wi)
                   * (lobe_shadowing(lobe, importon.shading_normal, wi) * shading_correction(cosine, geometric_cosine));
    }
    return value;
}

// How far the normals of photon and importon may part, as a cosine, and how far a photon may lie
// off the importon's tangent plane in radii: beyond, they are on different surfaces.
const float NORMAL_TOLERANCE = 0.7;
const float PLANE_TOLERANCE = 0.35;

// The gathering ray finds the rest, unless its path ends before.
float caustic_share(uint photon_number, float radius) {
    float radiance = world_radiances[photon_number % parameters.photon_count];
    bool found = radiance > 0.0 && photon_number / parameters.photon_count <= parameters.most_scattered;
    return found ? world_photon_share(radiance, parameters.world_photon_flux, radius) : 1.0;
}

// Eq. 1: what a photon adds to the radiance of an importon, with the kernel 2 (1 - x^2) / pi, whose
// integral over the unit disk is 1. False when it adds nothing. Most pairs are too far apart: only
// what decides that is read first.
bool density_estimate(uint importon_number, uint photon_number, float wide_radius, out vec3 radiance) {
    radiance = vec3(0.0);
    bool by_ray = importons[importon_number].gathers == GATHERS_BY_RAY;
    if (by_ray && (photons[photon_number].flags & PHOTON_INDIRECT) != 0u) return false;
    float narrow = importons[importon_number].radius;
    vec3 offset = photons[photon_number].position - importons[importon_number].position;
    float radius = photon_radius(photons[photon_number].flags, narrow, wide_radius), radius2 = radius * radius;
    float distance2 = dot(offset, offset);
    if (!(distance2 < radius2) || !(narrow > 0.0)) return false;
    vec3 geometric = unpack_unit_vector(importons[importon_number].geometric_normal);
    if (abs(dot(offset, geometric)) > PLANE_TOLERANCE * radius) return false;
    vec3 photon_normal = unpack_unit_vector(photons[photon_number].geometric_normal);
    float alignment = dot(geometric, photon_normal);
    if (abs(alignment) < NORMAL_TOLERANCE) return false;
    // Photons count on the side they arrived at; only transmission links the two sides.
    if (alignment < 0.0 && !lobe_transmits(unpack_kind(importons[importon_number].lobe_kind))
        && largest(importons[importon_number].translucent) <= 0.0) return false;
    vec3 direction = photons[photon_number].direction;
    Importon importon = importons[importon_number];
    float kernel = 2.0 * (1.0 - distance2 / radius2) / (PI * radius2);
    float geometric_cosine = abs(dot(photon_normal, direction));
    radiance = evaluate_importon(importon, direction, alignment > 0.0, geometric_cosine) * photons[photon_number].flux * kernel;
    if (by_ray && (photons[photon_number].flags & PHOTON_DIRECT) == 0u) radiance *= caustic_share(photon_number, narrow);
    return largest(radiance) > 0.0;
}
