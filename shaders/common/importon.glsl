// SPDX-License-Identifier: GPL-3.0-or-later
// The includer declares the storage blocks of photons[] and importons[] before.
#include "common/bsdf/microfacet.glsl"
#include "common/gathering.glsl"

// BSDF times path throughput of an importon for light from wi.
vec3 evaluate_importon(Importon importon, vec3 shading, vec3 wi) {
    vec3 value = dot(shading, wi) > 0.0 ? importon.diffuse : vec3(0.0);
    if (importon.lobe_kind != LOBE_NONE) {
        MicrofacetLobe lobe = MicrofacetLobe(importon.lobe_weight, importon.lobe_kind, importon.lobe_f0, importon.lobe_alpha, importon.lobe_ior);
        value += evaluate_lobe(lobe, shading, importon.direction, wi);
    }
    return value;
}

// How far the normals of photon and importon may part, as a cosine, and how far a photon may lie
// off the importon's tangent plane in radii: beyond, they are on different surfaces.
const float NORMAL_TOLERANCE = 0.7;
const float PLANE_TOLERANCE = 0.35;

// Eq. 1: what a photon adds to the radiance of an importon, with the kernel 2 (1 - x^2) / pi, whose
// integral over the unit disk is 1. False when it adds nothing. Most pairs are too far apart: only
// what decides that is read first.
bool density_estimate(uint importon_number, uint photon_number, float wide_radius, out vec3 radiance) {
    radiance = vec3(0.0);
    if (importons[importon_number].gathers == GATHERS_BY_RAY && (photons[photon_number].flags & PHOTON_INDIRECT) != 0u) return false;
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
    if (alignment < 0.0 && !lobe_transmits(importons[importon_number].lobe_kind)) return false;
    vec3 direction = photons[photon_number].direction;
    Importon importon = importons[importon_number];
    vec3 shading = unpack_unit_vector(importon.shading_normal);
    // Flux arrived by the geometric cosine; shading asks for its own.
    float correction = min(abs(dot(shading, direction)) / max(abs(dot(photon_normal, direction)), 1e-5), 4.0);
    float kernel = 2.0 * (1.0 - distance2 / radius2) / (PI * radius2);
    radiance = evaluate_importon(importon, shading, direction) * photons[photon_number].flux * (kernel * correction);
    return largest(radiance) > 0.0;
}
