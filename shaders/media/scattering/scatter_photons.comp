#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: MEDIA=1
// Photons in media: some of them are scattered before they come to a surface. They are stored there, and go on in a
// direction of the phase function; the stages of surfaces leave them alone in this segment.

layout(local_size_x = 64) in;

#include <ScatterInMediaParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/geometry.glsl"
#include "common/photon.glsl"
#include "common/path_depth.glsl"
#include "common/random.glsl"
#include "common/sampling.glsl"
#include "common/volume_bounces.glsl"
uniform Parameters { ScatterInMediaParameters parameters; };
readonly buffer Materials;
readonly buffer Media;
readonly buffer PhaseFunctions;
#include "materials/medium.glsl"
#include "common/phase_functions.glsl"
#include "media/free_flight.glsl"
readonly buffer Hits;
buffer Rays;
buffer PhotonPaths;
buffer PhotonDifferentials;
writeonly buffer Photons;
readonly buffer PhotonRange;

void store_photon(uint index, PhotonPath path, vec3 position, vec3 direction, vec3 flux, float distance) {
    const uint history = PHOTON_SCATTERED_BY_LOBE | PHOTON_CAUSTIC;
    uint flags = PHOTON_ACTIVE | (path.flags & (PHOTON_AFTER_ROUGH_BOUNCE | PHOTON_DIRECT | PHOTON_INDIRECT))
                 | ((path.flags << PHOTON_HISTORY_SHIFT) & history);
    photons[photon_first + active_place()] =
        Photon(position, flags, flux, 0u, -direction, distance, index | parameters.segment << PHOTON_SEGMENT_SHIFT,
               path.depth, path.medium_vertices | PHOTON_IN_MEDIUM, 0u);
}

vec3 turned(vec3 direction, float cosine, float angle) {
    vec3 t, b;
    tangent_frame(direction, t, b);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    return normalize(sine * (cos(angle) * t + sin(angle) * b) + cosine * direction);
}

// Ends a path whose light the media do not scatter, in place of the photon that it would store.
void end_path(uint index, PhotonPath path, Ray ray) {
    photons[photon_first + active_place()] =
        Photon(vec3(0.0), 0u, path.flux, 0u, -ray.direction, 0.0, index | parameters.segment << PHOTON_SEGMENT_SHIFT,
               path.depth, 0u, 0u);
    photon_paths[index].flux = vec3(0.0);
    photon_paths[index].flags |= PATH_SCATTERED_IN_MEDIUM;
    rays[index].maximum_distance = 0.0;
}

// Sends the path on from where a medium has scattered it. Russian roulette keeps the flux of photons even.
void sample_next_ray(uint index, PhotonPath path, Ray ray, vec3 position, vec3 weight, RandomSequence random) {
    vec3 flux = path.flux * weight;
    float u = next_random(random);
    PhaseFunction phase = sample_path_phase_function(path.flags, flux, u);
    flux *=
        phase.scattering * (dot(flux, path_medium(path.flags).scattering) / max(dot(flux, phase.scattering), 1e-30));
    float survival = min(largest(flux) / largest(path.flux), 1.0);
    float angle = 2.0 * PI * next_random(random);
    bool survives = next_random(random) < survival;
    uint medium_vertices = path.medium_vertices + 1u;
    if (medium_count(medium_vertices) == 1u && (path.flags & PHOTON_AFTER_ROUGH_BOUNCE) == 0u)
        medium_vertices |= FIRST_MEDIUM_LIT;
    if (bounces_of(path.depth) >= iteration.photon_bounces
        || !within_volume_bounces(medium_vertices, PHOTON_AFTER_ROUGH_BOUNCE, 0u)) {
        photon_paths[index].deposited = path.flux.x + path.flux.y + path.flux.z;
        survives = false;
    }
    vec3 direction = turned(ray.direction, sample_phase_function(phase, u), angle);
    // Light that lobes have sent into a medium makes no caustics beyond.
    const uint gone = PHOTON_INDIRECT | PHOTON_DIRECT | PHOTON_NOT_DIFFUSE | PHOTON_NOT_GLOSSY | PHOTON_NOT_TRANSMITTED
                      | PHOTON_CASTS_SHADOWS | PHOTON_SCATTERED_BY_LOBE >> PHOTON_HISTORY_SHIFT;
    photon_paths[index].flags = (path.flags & ~gone) | PHOTON_AFTER_ROUGH_BOUNCE | PATH_SCATTERED_IN_MEDIUM;
    photon_paths[index].flux = survives ? flux / survival : vec3(0.0);
    photon_paths[index].depth += ONE_BOUNCE;
    photon_paths[index].medium_vertices = medium_vertices;
    photon_differentials[index].known = 0u;
    photon_differentials[index].before = 0.0;
    rays[index] = Ray(position, NO_TRIANGLE, direction, survives ? INFINITY_DISTANCE : 0.0);
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    photon_paths[index].flags &= ~PATH_SCATTERED_IN_MEDIUM;
    PhotonPath path = photon_paths[index];
    Ray ray = rays[index];
    if (!(ray.maximum_distance > 0.0) || !(largest(path.flux) > 0.0)) return;
    MediumCoefficients medium = path_medium(path.flags);
    if (!(largest(medium.scattering) > 0.0)) return;
    vec3 extinction = medium.absorption + medium.scattering;
    bool escapes = hits[index].triangle == NO_TRIANGLE;
    float far = escapes ? INFINITY_DISTANCE : hits[index].distance;
    RandomSequence random = random_sequence(iteration.seed, iteration.number, STAGE_MEDIA, parameters.segment, index);
    FreeFlight flight = sample_free_flight(extinction, far, next_random2(random));
    if (!(flight.pdf > 0.0)) {
        // Surfaces weaken the flux by the transmittance, but nothing weakens what escapes.
        vec3 weight = vec3(1.0 / max(flight.passing, 1e-30));
        if (escapes) weight *= exp(-extinction * far);
        photon_paths[index].flux = path.flux * weight;
        return;
    }
    if ((path.medium_vertices & HIDDEN_FROM_MEDIA) != 0u && bounces_of(path.depth) == 0u) {
        end_path(index, path, ray);
        return;
    }
    vec3 position = ray.origin + flight.distance * ray.direction;
    vec3 weight = exp(-extinction * flight.distance) / flight.pdf;
    float distance = photon_differentials[index].before + flight.distance;
    store_photon(index, path, position, ray.direction, path.flux * weight * medium.scattering, distance);
    sample_next_ray(index, path, ray, position, weight, random);
}
