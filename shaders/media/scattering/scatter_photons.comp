#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: MEDIA=1 EMISSIVE_MEDIA=1
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
#include "photons/path_flags.glsl"
uniform Parameters { ScatterInMediaParameters parameters; };
readonly buffer Media;
#include "materials/medium.glsl"
#include "common/phase_functions.glsl"
#include "media/free_flight.glsl"
#include "media/thin_media.glsl"
#include "lights/light_table.glsl"
#include <LightFlags>
readonly buffer Hits;
buffer Rays;
buffer PhotonPaths;
buffer PhotonDifferentials;
writeonly buffer Photons;
readonly buffer PhotonRange;
#include <PhotonBeam>
buffer PhotonBeams;
readonly buffer PhotonOrigins;

// Whether media scatter no light of a path before something else has.
bool is_hidden(PhotonPath path) {
    return (path.bounce_counts & HIDDEN_FROM_MEDIA) != 0u && bounces_of(path.depth) == 0u;
}

void store_photon(uint index, PhotonPath path, vec3 position, vec3 direction, vec3 flux, float distance) {
    uint flags = PHOTON_ACTIVE | photon_flags(path.flags);
    photons[photon_first + active_place()] =
        Photon(position, flags, flux, 0u, -direction, distance, index | parameters.segment << PHOTON_SEGMENT_SHIFT,
               path.depth, path.bounce_counts | PHOTON_IN_MEDIUM, 0u);
}

// Whether shadow rays bring the light of a path that comes straight from its light.
bool is_for_shadow_rays(PhotonPath path) { return iteration.next_event != 0u && (path.flags & PHOTON_DIRECT) != 0u; }

// The way of the photon becomes a beam with a probability, which is larger for caustics.
void store_beam(uint index, PhotonPath path, Ray ray, float extent, float u) {
    if (is_for_shadow_rays(path) || is_hidden(path) || !is_thin(path.flags, parameters.least_free_path)) return;
    bool caustic = (path.flags & PHOTON_AFTER_ROUGH_BOUNCE) == 0u;
    float probability = min(parameters.beam_probability * (caustic ? 4.0 : 1.0), 1.0);
    if (u >= probability) return;
    PhotonOrigin origin = photon_origins[index];
    photon_beams[atomicAdd(beam_count, 1u)] = PhotonBeam(
        ray.origin, min(extent, parameters.longest_beam), ray.direction, photon_first + active_place(),
        path.flux / probability, photon_flags(path.flags), index | parameters.segment << PHOTON_SEGMENT_SHIFT,
        path.depth, path.bounce_counts, origin.light_group, origin.max_bounces, 0u, 0u, 0u);
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

// Sends the path on from where a medium has scattered it; scattering: the coefficient there, 1/m. Russian roulette
// keeps the flux of photons even.
void sample_next_ray(uint index, PhotonPath path, PlaceOnRay at, vec3 weight, vec3 scattering, RandomSequence random) {
    vec3 flux = path.flux * weight;
    float u = next_random(random);
    PhaseFunction phase = sample_path_phase_function(path.flags, at, flux, u);
    flux *= phase.scattering * (dot(flux, scattering) / max(dot(flux, phase.scattering), 1e-30));
    float survival = min(largest(flux) / largest(path.flux), 1.0);
    float u_around = next_random(random);
    bool survives = next_random(random) < survival;
    uint bounce_counts = medium_counted(path.bounce_counts);
    bool is_first = medium_count(bounce_counts) == 1u;
    if (is_first && is_light_direct(path.flags, path.depth)) bounce_counts |= FIRST_MEDIUM_LIT;
    if (bounces_of(path.depth) >= iteration.photon_bounces
        || !within_volume_bounces(bounce_counts, PHOTON_AFTER_ROUGH_BOUNCE, path.depth, 0u)) {
        photon_paths[index].deposited = path.flux.x + path.flux.y + path.flux.z;
        survives = false;
    }
    vec3 direction = direction_around(at.direction, sample_phase_function(phase, u), u_around);
    // Light that lobes have sent into a medium makes no caustics beyond.
    const uint gone = PHOTON_INDIRECT | PHOTON_DIRECT | PHOTON_NOT_DIFFUSE | PHOTON_NOT_GLOSSY | PHOTON_NOT_TRANSMITTED
                      | PHOTON_CASTS_SHADOWS | PHOTON_SCATTERED_BY_LOBE >> PHOTON_HISTORY_SHIFT;
    photon_paths[index].flags = (path.flags & ~gone) | PHOTON_AFTER_ROUGH_BOUNCE | PATH_SCATTERED_IN_MEDIUM;
    photon_paths[index].flux = survives ? flux / survival : vec3(0.0);
    photon_paths[index].depth += ONE_BOUNCE;
    photon_paths[index].bounce_counts = bounce_counts;
    photon_differentials[index].known = 0u;
    photon_differentials[index].before = 0.0;
    rays[index] =
        Ray(at.origin + at.distance * at.direction, NO_TRIANGLE, direction, survives ? INFINITY_DISTANCE : 0.0);
}

// Of the light of a photon that comes straight from a lamp, what the lamp gives to a point of the photon's ray: Light
// Falloff nodes count by the distance, and a soft light faces each point with a disk that the ray meets, or misses, a
// little behind where it began (photon_emission/falloff.comp).
vec3 lamp_factor(uint index, PhotonPath path, Ray ray, float distance) {
    if (parameters.segment > 0u || parameters.has_falloff == 0u) return vec3(1.0);
    Light light = lights[light_of(index)];
    float factor = distance_factor(light, distance);
    if ((light.flags & LIGHT_SOFT) == 0u) return vec3(factor);
    float behind = soft_light_distance(light, ray.origin + distance * ray.direction, -ray.direction) - distance;
    if (!(behind > -distance)) return vec3(0.0);
    behind = max(behind, 0.0);
    return factor * segment_transmittance(path.flags, ray.origin - behind * ray.direction, ray.direction, behind);
}

// Changes the flux of a path that passes the media, or ends it.
void pass_on(uint index, vec3 flux) {
    photon_paths[index].flux = flux;
    if (!(largest(flux) > 0.0)) rays[index].maximum_distance = 0.0;
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    photon_paths[index].flags &= ~PATH_SCATTERED_IN_MEDIUM;
    PhotonPath path = photon_paths[index];
    Ray ray = rays[index];
    if (!(ray.maximum_distance > 0.0) || !(largest(path.flux) > 0.0)) return;
    bool escapes = hits[index].triangle == NO_TRIANGLE;
    float far = escapes ? ray.maximum_distance : hits[index].distance;
    if (!path_may_scatter(path.flags)) {
        if (!escapes) pass_on(index, path.flux * lamp_factor(index, path, ray, far));
        return;
    }
    RandomSequence random = random_sequence(iteration.seed, iteration.number, STAGE_MEDIA, parameters.segment, index);
    FreeFlight flight = sample_free_flight(path.flags, ray, far, next_random2(random));
    bool passes = !(flight.pdf > 0.0);
    store_beam(index, path, ray, passes ? far : flight.distance, next_random(random));
    if (passes) {
        // Surfaces weaken the flux by the transmittance, but nothing weakens what escapes.
        vec3 weight = vec3(1.0 / max(dot(flight.transmittance, vec3(1.0 / 3.0)), 1e-30));
        if (escapes) weight *= flight.transmittance;
        else weight *= lamp_factor(index, path, ray, far);
        pass_on(index, path.flux * weight);
        return;
    }
    path.flux *= lamp_factor(index, path, ray, flight.distance);
    if (is_hidden(path) || !(largest(path.flux) > 0.0)) {
        end_path(index, path, ray);
        return;
    }
    vec3 position = ray.origin + flight.distance * ray.direction;
    PlaceOnRay at = PlaceOnRay(ray.origin, ray.direction, flight.distance);
    vec3 weight = flight.transmittance / flight.pdf;
    float distance = photon_differentials[index].before + flight.distance;
    vec3 scattering = path_medium(path.flags, at).scattering;
    store_photon(index, path, position, ray.direction, path.flux * weight * scattering, distance);
    sample_next_ray(index, path, at, weight, scattering, random);
}
