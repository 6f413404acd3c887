#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: PORTALS=1
// lint: MEDIA=1 EMISSIVE_MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1 EMISSIVE_MEDIA=1
// lint: EMITTERS=lights/two_levels
// lint: EMITTERS=lights/two_levels MEDIA=1 HETEROGENEOUS_MEDIA=1 EMISSIVE_MEDIA=1
// DirectPhotonHits, first half: photons leave the lights (paper section 4.3).

layout(local_size_x = 64) in;

#include <EmitParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/low_discrepancy.glsl"
#include "common/photon.glsl"
uniform Parameters { EmitParameters parameters; };
#include "photons/photon_emission/photons.glsl"
writeonly buffer Rays;
writeonly buffer PhotonPaths;
writeonly buffer PhotonCells;

writeonly buffer PhotonOrigins;
writeonly buffer PhotonDifferentials;

#include EMITTERS "lights/one_level/hits.glsl"
#include <GuideCells>
#include <LightGroups>

// The light's own radius, meters, or of a sun the angle of its disk's.
float light_extent(Light light) {
    if (light.kind == LIGHT_SUN) return sqrt(max(0.0, 1.0 - light.cosine_cone * light.cosine_cone));
    return is_area_light(light) ? 0.5 * (length(light.axis_u) + length(light.axis_v)) : light.radius;
}

// Directions and places in which the neighbors of a photon leave. The environment and emissive meshes are as large as
// the surfaces that they light: of these, only the distance counts. before: from the light to where the ray begins.
PhotonDifferential leaving_differential(Light light, Emission emission, float before) {
    bool parallel = light.kind == LIGHT_SUN;
    if (parallel || light.kind == LIGHT_WORLD) before = INFINITY_DISTANCE;
    bool known = emission.pdf > 0.0 && light.kind != LIGHT_WORLD && !has_part(light);
    vec3 t, b;
    tangent_frame(emission.direction, t, b);
    float apart = known ? inversesqrt(emission.pdf * float(light.photon_count)) : 0.0, extent = light_extent(light);
    vec3 none = vec3(0.0);
    return PhotonDifferential(parallel ? apart * t : none, known ? 1u : 0u, parallel ? none : apart * t,
                              parallel ? 0.0 : extent, parallel ? apart * b : none, parallel ? extent : 0.0,
                              parallel ? none : apart * b, before);
}

bool is_hidden_from_media(Light light, Emission emission) {
    if (emission.triangle != NO_EMITTER) return emitter_is_hidden_from_media(emission.triangle);
    return (light.flags & RAY_VOLUME_SCATTER) == 0u;
}

// Rays that start far away lose precision: they start where they enter the scene's sphere. False:
// they pass it by. Where a medium fills the world, light is weakened and scattered on the whole way.
bool enter_scene(inout vec3 origin, vec3 direction) {
    if (parameters.fills_world != 0u) return true;
    vec3 offset = origin - iteration.scene_center;
    float along = dot(offset, direction);
    float outside = dot(offset, offset) - iteration.scene_radius * iteration.scene_radius;
    if (outside <= 0.0) return true;
    vec3 nearest = offset - along * direction;
    float under = iteration.scene_radius * iteration.scene_radius - dot(nearest, nearest);
    if (under < 0.0 || along > 0.0) return false;
    origin += max(0.0, 0.999 * (-along - sqrt(under))) * direction;
    return true;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint number = light_of(index);
    Light light = lights[number];
    // The light's photons take turns: the last of each period is aimed, the others go anywhere.
    uint turn = index - light.first_photon, period = aiming_period(light);
    bool aims = parameters.target_count > 0u && (light.flags & LIGHT_THROUGH_PORTALS) == 0u;
    bool aimed = aims && turn % period == period - 1u;
    uint within = aimed ? turn / period : turn - (aims ? turn / period : 0u);
    // A fresh scrambled set for every light and iteration, stratified among the light's photons.
    uvec4 seed = pcg4d(uvec4(2u * number + (aimed ? 1u : 0u), iteration.number, iteration.seed, STAGE_EMISSION));
    vec2 u_parts = scrambled_sobol(within, pcg4d(seed + 1u));
    EmissionChoice choice = EmissionChoice(scrambled_sobol(within, seed), scrambled_sobol(within, pcg4d(seed)),
                                           u_parts.x, u_parts.y, aimed, aimed_fraction(light));
    photon_cells[index] = NO_CELL;
    if (!aimed) {
        // Evenly spaced from a random start: each cell gets its part but for one photon.
        uint step = 0xffffffffu / max(light.photon_count - aimed_photons(light), 1u);
        uint cell = choose_guide_cell(light, seed.x + within * step + pcg4d(seed + within).y % step);
        vec2 place = has_part(light) ? vec2(choice.part, 0.0) : choice.place;
        place_in_cell(light, cell, place, choice.direction);
        if (has_part(light)) choice.part = place.x;
        else choice.place = place;
        photon_cells[index] = light.first_cell + cell;
    }
    Emission emission = emit_photon(light, choice);
    vec3 flux = emission.flux / float(max(light.photon_count, 1u));
    if (light.kind == LIGHT_SUN || light.kind == LIGHT_WORLD) flux *= parameters.world_transmittance;
    bool dark = !(largest(flux) > 0.0);
    uint path_flags = PHOTON_DIRECT | ((light.flags & RAY_DIFFUSE) == 0u ? PHOTON_NOT_DIFFUSE : 0u)
                      | ((light.flags & RAY_GLOSSY) == 0u ? PHOTON_NOT_GLOSSY : 0u)
                      | ((light.flags & RAY_TRANSMISSION) == 0u ? PHOTON_NOT_TRANSMITTED : 0u)
                      | (light.kind != LIGHT_WORLD ? PHOTON_CASTS_SHADOWS : 0u);
#ifdef EMISSIVE_MEDIA
    // The light of media is found by the rays of final gathers, and not by shadow rays.
    if (light.kind == LIGHT_MEDIUM)
        path_flags =
            (path_flags & ~(PHOTON_DIRECT | PHOTON_CASTS_SHADOWS)) | PHOTON_AFTER_ROUGH_BOUNCE | PHOTON_INDIRECT;
#endif
    photon_origins[index] = PhotonOrigin(0.0, light.max_bounces, NO_LIGHT_GROUP);
    if (light.kind == LIGHT_WORLD) photon_origins[index].radiance = largest(world_radiance(-emission.direction));
    photon_paths[index] = PhotonPath(dark ? vec3(0.0) : flux, path_flags, 0u, 0.0, 0.0,
                                     is_hidden_from_media(light, emission) ? HIDDEN_FROM_MEDIA : 0u);
    vec3 left_from = emission.origin;
#ifdef EMISSIVE_MEDIA
    bool traced = !dark && (light.kind == LIGHT_MEDIUM || enter_scene(emission.origin, emission.direction));
#else
    bool traced = !dark && enter_scene(emission.origin, emission.direction);
#endif
    float before = distance(left_from, emission.origin);
    photon_differentials[index] = leaving_differential(light, emission, before);
    if (emission.reach < INFINITY_DISTANCE) emission.reach = max(emission.reach - before, 0.0);
    uint source = keep_left_emitter(emission.triangle, index);
    rays[index] = Ray(emission.origin, source, emission.direction, traced ? emission.reach : 0.0);
}
