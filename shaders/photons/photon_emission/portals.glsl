// SPDX-License-Identifier: GPL-3.0-or-later
// Photons of the world leave by two lights of the table: from a disk across their direction that holds the scene, or
// through portals. Each carries its flux over the pdf of both together (balance heuristic, Veach 1997, section 9.2), so
// portals move noise and no energy, wherever they are. All begin outside of the scene: what is before a window shades
// it.

// Area across a direction, m^2; 0 where light goes the other way.
#include "common/iteration.glsl"
float portal_across(Light portal, vec3 direction) { return portal.area * max(dot(direction, portal.normal), 0.0); }

float portals_across(vec3 direction) {
    float sum = 0.0;
    for (uint k = 0u; k < iteration.portal_count; ++k) sum += portal_across(portal_at(k), direction);
    return sum;
}

// A point of the portals, relative to the scene's center, even across the direction. u.x: among the portals by their
// part, and within that. sampled: which it is of.
vec3 sample_portals(vec3 direction, float across, vec2 u, out uint sampled) {
    float rest = u.x * across;
    vec3 place = vec3(0.0);
    sampled = NO_PORTAL;
    for (uint k = 0u; k < iteration.portal_count; ++k) {
        Light portal = portal_at(k);
        float part = portal_across(portal, direction);
        if (!(part > 0.0)) continue;
        vec2 square = vec2(clamp(rest / part, 0.0, 1.0), u.y);
        vec2 at = portal.kind == LIGHT_ELLIPSE ? sample_disk(square) : 2.0 * square - 1.0;
        place = portal.position + at.x * portal.axis_u + at.y * portal.axis_v - iteration.scene_center;
        sampled = k;
        if (rest < part) break;
        rest -= part;
    }
    return place;
}

// Pdf in 1/m^2 across the direction with which they are passed at a place, by the guide of their light as well.
float portals_pdf(Light light, vec3 direction, float across, vec3 place, vec2 direction_square, uint sampled) {
    float before = 0.0, sum = 0.0;
    for (uint k = 0u; k < iteration.portal_count; ++k) {
        Light portal = portal_at(k);
        float part = portal_across(portal, direction);
        if (!(part > 0.0)) continue;
        vec3 offset = iteration.scene_center + place - portal.position;
        vec2 at = area_light_coordinates(
            portal, offset - dot(offset, portal.normal) / dot(direction, portal.normal) * direction);
        // Rounding must not take a photon for one that misses its own portal.
        if (k == sampled || is_on_area_light(portal, at)) {
            vec2 square = portal.kind == LIGHT_ELLIPSE ? disk_to_square(at) : 0.5 + 0.5 * at;
            vec2 among = vec2((before + part * clamp(square.x, 0.0, 1.0)) / across, square.y);
            sum += guide_pdf(light, guide_cell(light, among, direction_square));
        }
        before += part;
    }
    return sum / across;
}

// Pdf in 1/m^2 of a place on the disk, as emit_from_infinity has it.
float world_disk_pdf(Light light, vec3 t, vec3 b, vec2 place, vec2 direction_square, EmissionChoice choice) {
    float radius = iteration.scene_radius, shadows = target_shadows();
    bool has_targets = shadows > 0.0;
    float plain = dot(place, place) <= radius * radius ? 1.0 / (PI * radius * radius) : 0.0;
    choice.aimed_fraction = aimed_fraction(light);
    return mixed_pdf(light, plain, disk_to_square(place / radius), direction_square,
                     has_targets ? target_shadow_pdf(t, b, shadows, place) : 0.0, has_targets, choice);
}

Emission emit_from_world(Light light, EmissionChoice choice) {
    bool by_portals = (light.flags & LIGHT_THROUGH_PORTALS) != 0u, has_portals = iteration.portal_count > 0u;
    Light disk = lights[iteration.world_light], portals = lights[iteration.portal_light];
    float direction_pdf, portal_direction_pdf = 0.0;
    vec3 toward = sample_directions(directions_of(light), choice.direction, direction_pdf);
    float world_direction_pdf = by_portals ? world_pdf(toward) : direction_pdf;
    if (by_portals) portal_direction_pdf = direction_pdf;
    else if (has_portals) portal_direction_pdf = table_pdf(directions_of(portals), toward);
    vec3 direction = -toward, t, b;
    tangent_frame(direction, t, b);
    float across = portals_across(direction), radius = iteration.scene_radius, shadows = target_shadows();
    Emission none = Emission(iteration.scene_center, NO_EMITTER, direction, vec3(0.0), 0.0, 0.0);
    if (by_portals && !(across > 0.0)) return none;
    uint sampled = NO_PORTAL;
    vec2 place;
    if (by_portals) {
        vec3 at = sample_portals(direction, across, choice.place, sampled);
        place = vec2(dot(at, t), dot(at, b));
    } else if (choice.aimed && shadows > 0.0) place = sample_target_shadow(t, b, shadows, choice.target, choice.place);
    else place = radius * sample_disk(choice.place);
    vec2 world_square = by_portals ? world_to_square(toward) : choice.direction;
    float disk_pdf = world_disk_pdf(disk, t, b, place, world_square, choice);
    float pdf = float(disk.photon_count) * world_direction_pdf * disk_pdf;
    if (portal_direction_pdf > 0.0 && across > 0.0) {
        vec2 portal_square = by_portals ? choice.direction : table_to_square(directions_of(portals), toward);
        float place_pdf = portals_pdf(portals, direction, across, place.x * t + place.y * b, portal_square, sampled);
        pdf += float(portals.photon_count) * portal_direction_pdf * place_pdf;
    }
    pdf /= float(max(light.photon_count, 1u));
    if (!(pdf > 0.0)) return none;
    vec3 origin = iteration.scene_center + place.x * t + place.y * b - radius * direction;
    return Emission(origin, NO_EMITTER, direction, world_radiance(toward) / pdf, pdf, INFINITY_DISTANCE);
}
