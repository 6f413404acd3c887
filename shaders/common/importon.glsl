// SPDX-License-Identifier: GPL-3.0-or-later
// The includer declares the blocks Importons and Photons before.
#include "common/iteration.glsl"
#include "common/photon.glsl"
#include "common/bsdf/microfacet.glsl"
#include "common/sampling.glsl"
#include "common/whole_numbers.glsl"
#include "common/gathering.glsl"
#include "common/world_light.glsl"
#include "common/path_history.glsl"
#include "common/path_depth.glsl"
#include "common/surface_tolerance.glsl"
readonly buffer PhotonOrigins;
#include "common/photon_depth.glsl"
#ifdef DROPS_CAUSTICS
#include <CausticKinds>
#endif
#ifdef COUNTS_BOUNCES
#include "common/bounce_limits.glsl"
#include <CameraPath>
readonly buffer CameraPaths;
#endif

// An importon, by its number: its members are read where they are asked for, since processors have no registers for
// all of them. Where reading them each time costs more (gl/buffers/texel_buffers.py), a copy.
#ifdef READS_TEXELS
#define IMPORTON Importon importon
#define ITS importon
#define IMPORTON_OF(copy, number) copy
#else
#define IMPORTON uint importon
#define ITS importons[importon]
#define IMPORTON_OF(copy, number) number
#endif

// Flux arrived by the geometric cosine; a part of the BSDF asks for that of its own normal.
float shading_correction(float cosine, float geometric_cosine) {
    return min(abs(cosine) / max(geometric_cosine, 1e-5), 4.0);
}

// BSDF times path throughput of an importon for a photon from wi, in front or behind; geometric_cosine: by which
// the photon arrived; parts: whether the diffuse part and the lobe may scatter it; diffuse: what of it is diffuse.
vec3 evaluate_importon(IMPORTON, vec3 wi, bool front, float geometric_cosine, bvec2 parts, out vec3 diffuse) {
    vec3 normal = unpack_unit_vector(ITS.diffuse_normal);
    float cosine = dot(normal, wi);
    vec3 value = vec3(0.0);
    if ((cosine > 0.0) == front && parts.x) {
        value = (front ? ITS.diffuse : ITS.translucent)
                * rough_diffuse_factor(ITS.diffuse_roughness, normal, ITS.direction, wi);
        value *= shading_correction(cosine, geometric_cosine);
        if (front) value *= bump_shadowing(unpack_unit_vector(ITS.shading_normal), normal, wi);
    }
    diffuse = value;
    uint kind = unpack_kind(ITS.lobe_kind);
    if (kind != LOBE_NONE && parts.y) {
        normal = unpack_unit_vector(ITS.lobe_normal);
        cosine = dot(normal, wi);
        MicrofacetLobe lobe =
            MicrofacetLobe(ITS.lobe_weight, kind, ITS.lobe_f0, ITS.lobe_alpha, unpack_tint(ITS.lobe_kind), ITS.lobe_ior,
                           ITS.lobe_normal, ITS.lobe_anisotropy);
        if (lobe_faces(lobe, cosine, front))
            value += evaluate_lobe(lobe, normal, ITS.direction, wi)
                     * (lobe_shadowing(lobe, ITS.shading_normal, wi) * shading_correction(cosine, geometric_cosine));
    }
    return value;
}

// MIS weight of a photon that brings a caustic to the origin of a final gather, whose ray brings the rest unless the
// path ends before. It brings nothing that media have scattered.
float caustic_mis_weight(uint photon_number, uint importon_history, float radius) {
    float radiance = photon_origins[photon_path_of(photons[photon_number].path)].radiance;
    uint bounces = bounces_of(arrived_depth(importon_history) + photons[photon_number].depth);
    bool ray_arrives = radiance > 0.0 && bounces <= iteration.camera_bounces
                       && medium_count(photons[photon_number].bounce_counts) == 0u;
    return ray_arrives ? photon_power_heuristic(radiance, iteration.photon_flux, radius) : 1.0;
}

// What decides first of a pair, since most are too far apart: whether a photon lies within the radius in which it
// counts at an importon. offset: from importon to photon.
bool within_reach(uint gathers, vec3 offset, float radius, uint photon_flags) {
    if ((gathers & FINAL_GATHER_ORIGIN) != 0u && (photon_flags & PHOTON_INDIRECT) != 0u) return false;
    return dot(offset, offset) < radius * radius;
}

// The bounces by type of the path of an importon, by its number, as it came.
uint arrived_counts(uint number) {
#ifdef COUNTS_BOUNCES
    return camera_paths[number].arrived_counts;
#else
    return 0u;
#endif
}

// Whether the limits by type let a lobe of a type scatter a photon to a camera path with some counts, and the photon is
// no caustic that is left out. The scattering is a bounce unless the photon comes from its light.
bool may_scatter(uint counts, uint photon_number, uint scatter, bool transmitted) {
#ifdef DROPS_CAUSTICS
    bool is_caustic = (photons[photon_number].depth >> CAUSTIC_SHIFT & iteration.dropped_caustics) != 0u;
    if (is_caustic && scatter == SCATTER_DIFFUSE) return false;
#endif
#ifdef COUNTS_BOUNCES
    bool is_bounce = bounces_of(photons[photon_number].depth) > 0u;
    uint own = is_bounce ? counted(0u, counted_scatter(scatter, transmitted)) : 0u;
    return !exceed_limits(counts_of(counts) + counts_of(photons[photon_number].bounce_counts) + counts_of(own));
#else
    return true;
#endif
}

// What global photons count for: the disk's area over that of the surface in it (camera_paths/coverage/probe.comp).
float photon_factor(uint gathers) { return float(max(gathers >> PHOTON_FACTOR_SHIFT, 1u)); }

// Vertices of an importon's path in media.
uint vertices_in_media(uint gathers) {
#ifdef MEDIA
    return (gathers >> IMPORTON_MEDIUM_SHIFT) & MOST_MEDIUM_VERTICES;
#else
    return 0u;
#endif
}

// Light that a photon adds to an importon, what of it is diffuse, and whether it came from the viewer's side.
struct Estimate {
    vec3 radiance;
    vec3 diffuse;
    bool front;
};

// Eq. 1: what a photon adds to the radiance of an importon, with the kernel 2 (1 - x^2) / pi, whose
// integral over the unit disk is 1. False when it adds nothing. stands_for: how many photons the importon's disk holds
// for each that counts within so much less of it. counts: the arrived_counts of the importon.
bool density_estimate(IMPORTON, uint counts, uint photon_number, out Estimate estimate, out uint stands_for) {
    uint flags = photons[photon_number].flags;
    vec3 offset = photons[photon_number].position - ITS.position;
    float radius = photon_radius(flags, ITS.minimum_radius, ITS.radius, iteration.wide_radius);
    float radius2 = radius * radius;
    if (!(ITS.radius > 0.0) || !within_reach(ITS.gathers, offset, radius, flags)) return false;
    float disks = ITS.radius * ITS.radius / radius2;
    stands_for = whole_word(floor(max(disks, 1.0) + 0.5));
    vec3 geometric = unpack_unit_vector(ITS.geometric_normal);
    float height = dot(offset, geometric);
    if (abs(height) > PHOTON_PLANE_TOLERANCE * radius) return false;
    vec3 photon_normal = unpack_unit_vector(photons[photon_number].geometric_normal);
    float alignment = dot(geometric, photon_normal);
    if (abs(alignment) < PHOTON_NORMAL_TOLERANCE) return false;
    // Photons count on the side they arrived at; only transmission links the two sides.
    uint kind = unpack_kind(ITS.lobe_kind);
    if (alignment < 0.0 && !lobe_transmits(kind) && largest(ITS.translucent) <= 0.0) return false;
    if (exceeds_depth(arrived_depth(ITS.history), photon_number, vertices_in_media(ITS.gathers))) return false;
    vec3 direction = photons[photon_number].direction;
    float side = alignment > 0.0 ? 1.0 : -1.0, away = photons[photon_number].distance;
    if (is_shut_off(side * height, dot(offset, photon_normal), side * dot(direction, geometric) * away, away, radius)
        && !lobe_is_hair(kind))
        return false;
    float kernel = 2.0 * (1.0 - dot(offset, offset) / radius2) / (PI * radius2);
    estimate.front = alignment > 0.0;
    bool behind = !estimate.front;
    bvec2 parts = bvec2(may_scatter(counts, photon_number, SCATTER_DIFFUSE, behind),
                        may_scatter(counts, photon_number, lobe_scatter(kind, behind), behind));
    vec3 radiance = evaluate_importon(importon, direction, estimate.front, abs(dot(photon_normal, direction)), parts,
                                      estimate.diffuse);
    vec3 flux = photons[photon_number].flux;
    if ((flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u) kernel *= photon_factor(ITS.gathers);
    radiance = radiance * flux * kernel;
    estimate.diffuse = estimate.diffuse * flux * kernel;
    float mis_weight = 1.0;
    if ((flags & PHOTON_DIRECT) == 0u && (ITS.gathers & FINAL_GATHER_ORIGIN) != 0u)
        mis_weight = caustic_mis_weight(photon_number, ITS.history, disk_radius(ITS.minimum_radius, ITS.radius));
    estimate.radiance = radiance * mis_weight;
    estimate.diffuse *= mis_weight;
    return largest(estimate.radiance) > 0.0;
}
