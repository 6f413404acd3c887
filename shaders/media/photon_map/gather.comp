#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: MEDIA=1 RAY_PORTALS=1
// lint: MEDIA=1 EMISSIVE_MEDIA=1
// Each ray of a camera path in scattering media gathers the photons around one point on it, which is sampled as
// media scatter light, with a three-dimensional kernel. The rays of final gathers leave that light to the photons at
// the surface where they begin, and straight camera rays in thin media to photon beams.

layout(local_size_x = 64) in;

#include <GatherInMediaParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/geometry.glsl"
#include "common/photon.glsl"
#include "common/path_depth.glsl"
#include "common/camera_path.glsl"
#include "common/low_discrepancy.glsl"
#include "common/bsdf/closure.glsl"
#include "common/path_history.glsl"
#include <Importon>
uniform Parameters { GatherInMediaParameters parameters; };
readonly buffer Media;
#include "materials/medium.glsl"
#include "common/phase_functions.glsl"
#include "media/free_flight.glsl"
#include "media/thin_media.glsl"
#include "media/straight_paths.glsl"
#include "media/medium_gather.glsl"
#include "density_estimation/photon_grid/cells.glsl"
readonly buffer Rays;
readonly buffer CameraPaths;
readonly buffer MediumVertices;
buffer Photons;
readonly buffer PhotonOrigins;
#include "common/photon_depth.glsl"
readonly buffer Importons;
#include "density_estimation/splat_sums/collect.glsl"
#include "density_estimation/splat_sums/add_light.glsl"
buffer Buckets;
readonly buffer SortedPhotons;

#include "media/photon_map/kernel.glsl"
#include "media/photon_map/straight_photons.glsl"

#include <MediumPhotonKernel>

// Among many photons, the radius shrinks to that of a sphere of so many, but not further than to a part of it.
const float MOST_EXPECTED = 32.0, MOST_EXPECTED_SMOOTH = 200.0, LEAST_RADIUS_FACTOR = 0.25;

// A point where photons are gathered, and what they count for.
struct GatherPoint {
    vec3 position;
    vec3 direction;  // of the camera ray
    vec3 weight;     // throughput and transmittance over the pdf of the distance, m
    vec3 scattering;
    PlaceOnRay at;
    uint flags;
    uint depth;
    uint media;      // vertices of the path in media, with this one
    bool takes_all;  // photons, or only those that have come straight to the medium
};

// Radiance that a photon adds.
vec3 photon_radiance(GatherPoint point, uint photon, float distance2, float radius) {
    float cosine = dot(photons[photon].direction, point.direction);
    vec3 phase = scattered_phase(point.flags, point.at, cosine) / max(point.scattering, vec3(1e-30));
    return point.weight * phase * photons[photon].flux * photon_kernel(distance2, radius);
}

// In dense media that are the same everywhere, light is nearly even within a part of the mean free path.
float smooth_radius(GatherPoint point) {
    if (has_any_grid(point.flags)) return parameters.radius;
    MediumCoefficients medium = path_medium(point.flags, point.at);
    float free_path = 3.0 / max(dot(medium.absorption + medium.scattering, vec3(1.0)), 1e-30);
    return clamp(parameters.free_paths * free_path, parameters.radius, WIDEST * parameters.radius);
}

// The radius where cells hold so many photons.
float crowded_radius(float radius, float photons_a_cell) {
    float side = parameters.side, least = LEAST_RADIUS_FACTOR * parameters.radius;
    float expected = photons_a_cell * 4.0 / 3.0 * PI * radius * radius * radius / (side * side * side);
    float most = radius > parameters.radius ? MOST_EXPECTED_SMOOTH : MOST_EXPECTED;
    return expected > most ? max(radius * pow(most / expected, 1.0 / 3.0), least) : radius;
}

// Adds a photon's light to the sums for passes: behind surfaces that have scattered the path, to those of the first.
void add_light(uint pixel, uint photon, vec3 radiance) {
    uint history = parameters.segment == 0u ? 0u : departing_history(importons[pixel].history);
    if ((parameters.light_sums & LIGHT_SUMS_GROUPS) != 0u)
        add_to_group_sum(pixel, photon_origins[photon_path_of(photons[photon].path)].light_group, false, radiance);
    uint flags = photons[photon].flags, first = first_scatter(history);
    bool indirect =
        is_indirect(flags, photons[photon].bounce_counts, photons[photon].depth) || is_scattered_by_medium(history);
    if ((parameters.light_sums & LIGHT_SUMS_VOLUME) != 0u)
        add_to_light_sum(pixel, first == SCATTER_NONE ? volume_sum(indirect) : scattered_sum(first, true), radiance);
    bool is_caustic = (history & HISTORY_CAUSTIC) != 0u || (flags & PHOTON_CAUSTIC) != 0u;
    if ((parameters.light_sums & LIGHT_SUMS_CAUSTICS) != 0u && is_caustic)
        add_to_light_sum(pixel, CAUSTICS_SUM, radiance);
}

void collect_photon(inout Collected collected, uint pixel, uint photon, vec3 radiance) {
    photons[photon].depth = photons[photon].depth | PHOTON_CONTRIBUTED;
    collect_splat(collected, photon, radiance, false, 0u);
    if (parameters.light_sums != 0u) add_light(pixel, photon, radiance);
}

GatherPoint gather_point(uint index, CameraPath path, Ray ray) {
    float far = medium_vertices[index].far;
    uvec4 scramble =
        pcg4d(uvec4(parameters.first_pixel + index, parameters.segment, iteration.seed, STAGE_MEDIUM_PHOTONS << 24u));
    vec3 thickness = medium_vertices[index].thickness, transmittance;
    float distance =
        sample_scattered_flight(path.flags, ray, far, thickness, scrambled_sobol(iteration.number - 1u, scramble));
    float pdf = scattered_flight_pdf(path.flags, ray, far, distance, thickness, transmittance);
    vec3 weight = path.throughput * transmittance / max(pdf, 1e-30);
    PlaceOnRay at = PlaceOnRay(ray.origin, ray.direction, distance);
    return GatherPoint(ray.origin + distance * ray.direction, ray.direction, weight,
                       path_medium(path.flags, at).scattering, at, path.flags, path.depth,
                       medium_count(path.bounce_counts) + 1u, !(path.medium_passing < 1.0));
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray ray = rays[index];
    CameraPath path = camera_paths[index];
    if (!(ray.maximum_distance > 0.0) || !takes_scattered_light(path)) return;
    if (parameters.straight_photons == 0u && path.medium_passing < 1.0) return;
    if (bounces_of(path.depth) > iteration.camera_bounces) return;
    if (!path_may_scatter(path.flags)) return;
    if (parameters.draws_beams != 0u && is_straight(path) && is_thin(path.flags, parameters.least_free_path)) return;
    GatherPoint point = gather_point(index, path, ray);
    if (!(largest(point.scattering) > 0.0)) return;
    float radius = smooth_radius(point);
    ivec3 low = cell_of(point.position - radius, parameters.side);
    bvec3 steps = greaterThan(cell_of(point.position + radius, parameters.side), low);
    uint step_bits = (steps.x ? 1u : 0u) | (steps.y ? 2u : 0u) | (steps.z ? 4u : 0u);
    uvec2 ranges[8];
    uint found = 0u, cells = 0u;
    for (uint corner = 0u; corner < 8u; ++corner) {
        ranges[corner] = uvec2(0u);
        if ((corner & ~step_bits) != 0u) continue;
        ivec3 cell = low + ivec3(corner & 1u, (corner >> 1u) & 1u, corner >> 2u);
        ranges[corner] = buckets[bucket_of(cell, parameters.buckets)];
        found += ranges[corner].y - ranges[corner].x;
        ++cells;
    }
    radius = crowded_radius(radius, float(found) / float(cells));
    MediumVertex segment = medium_vertices[index];
    if (has_any_grid(path.flags))
        point.weight *= scattering_over_mean(path.flags, ray, segment, point.at.distance, point.scattering, radius);
    point.weight /= 1.0 - kernel_beyond_surfaces(ray, segment, point.at.distance, radius);
    Collected collected = Collected(uvec2(0u), uvec2(0u), uvec2(0u), 0u, 0u, uvec2(0u));
    uint passed = 0u, corner = 0u, next = ranges[0].x;
    uint pairs = 0u;
    // Candidates before parameters.first_candidate were taken by an earlier dispatch.
    for (uint rounds = 0u; rounds < parameters.candidates && corner < 8u; ++rounds) {
        while (corner < 8u && next >= ranges[corner].y) {
            ++corner;
            if (corner < 8u) next = ranges[corner].x;
        }
        if (corner == 8u) break;
        if (passed < parameters.first_candidate) {
            uint skipped = min(parameters.first_candidate - passed, ranges[corner].y - next);
            passed += skipped;
            next += skipped;
            continue;
        }
        uvec4 candidate = sorted_photons[next++];
        vec3 offset = uintBitsToFloat(candidate.xyz) - point.position;
        float distance2 = dot(offset, offset);
        if (distance2 >= radius * radius || exceeds_depth(point.depth, candidate.w, point.media)) continue;
        if (!point.takes_all && !has_come_straight(candidate.w)) continue;
        vec3 radiance = photon_radiance(point, candidate.w, distance2, radius);
        if (!(largest(radiance) > 0.0)) continue;
        ++pairs;
        collect_photon(collected, index, candidate.w, radiance);
    }
    if (pairs > 0u) write_collected(index, scattered_light_is_gathered(path), collected);
    if (parameters.counting != 0u) atomicAdd(pairs_in_media, pairs);
}
