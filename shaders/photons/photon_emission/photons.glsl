// SPDX-License-Identifier: GPL-3.0-or-later
// Photons that leave the lights. Flux is that of the whole light over the pdf of the choice;
// the caller shares it out.

#include "common/iteration.glsl"
#include "lights/lights.glsl"
#include "common/light_sets.glsl"
#include "photons/photon_emission/aim.glsl"
#include "lights/guide.glsl"

// pdf: of the direction from a place in 1/sr, or of the place across parallel rays in 1/m^2. reach: how far it goes.
struct Emission {
    vec3 origin;
    EmitterNumber triangle;
    vec3 direction;
    vec3 flux;
    float pdf;
    float reach;
};

// Random numbers of one photon, whether it is aimed, and the fraction of those that are.
struct EmissionChoice {
    vec2 place;
    vec2 direction;
    float part;
    float target;
    bool aimed;
    float aimed_fraction;
};

// Pdf of both ways together over the plain one's measure: guided photons have the plain pdf times the
// guide's; aimed ones that see no target have the plain one.
float mixed_pdf(Light light, float plain, vec2 place, vec2 direction, float aimed, bool targets_seen,
                EmissionChoice choice) {
    float guided = plain * guide_pdf(light, guide_cell(light, place, direction));
    return mix(guided, targets_seen ? aimed : plain, choice.aimed_fraction);
}

Emission emit_from_infinity(Light light, vec3 direction, vec3 flux_density, EmissionChoice choice) {
    vec3 t, b;
    tangent_frame(direction, t, b);
    float radius = iteration.scene_radius, shadows = target_shadows();
    bool has_targets = shadows > 0.0;
    vec2 place = choice.aimed && has_targets ? sample_target_shadow(t, b, shadows, choice.target, choice.place)
                                             : radius * sample_disk(choice.place);
    float plain = dot(place, place) <= radius * radius ? 1.0 / (PI * radius * radius) : 0.0;
    float pdf = mixed_pdf(light, plain, disk_to_square(place / radius), choice.direction,
                          has_targets ? target_shadow_pdf(t, b, shadows, place) : 0.0, has_targets, choice);
    vec3 origin = iteration.scene_center + place.x * t + place.y * b - radius * direction;
    return Emission(origin, NO_EMITTER, direction, flux_density / pdf, pdf, INFINITY_DISTANCE);
}

// Fractions of the photons of a sphere with surfaces or a medium in it that light these: from its far side to its near.
const float WITHIN_FRACTION = 0.25, WITHIN_FRACTION_MEDIUM = 1.0 / 16.0;

// Radiant intensity from the light's center; a sphere of uniform radiance shows the same disk to every
// direction. A soft light is that disk. A sphere shines outward from its near side, and inward from its far side, where
// a spot light shines alike to all sides (Cycles).
Emission emit_from_point(Light light, EmissionChoice choice) {
    float part = 0.0;
    if ((light.flags & LIGHT_HOLDS_MEDIUM) != 0u) part = WITHIN_FRACTION_MEDIUM;
    if ((light.flags & (LIGHT_HOLDS_SURFACES | LIGHT_SOFT)) == LIGHT_HOLDS_SURFACES) part = WITHIN_FRACTION;
    bool within = choice.part < part, spot = light.kind == LIGHT_SPOT && !within;
    part = within ? part : 1.0 - part;
    float cones = target_cones(light.position);
    bool has_targets = cones > 0.0;
    vec3 direction = choice.aimed && has_targets
                         ? sample_target_direction(light.position, cones, choice.target, choice.direction)
                     : spot ? sample_cone(light.normal, light.spread_scale, choice.direction)
                            : sample_sphere(choice.direction);
    float plain = 1.0 / (4.0 * PI);
    if (spot)
        plain = dot(direction, light.normal) >= 1.0 - light.spread_scale ? 1.0 / (2.0 * PI * light.spread_scale) : 0.0;
    float aimed = has_targets ? target_direction_pdf(light.position, cones, direction) : 0.0;
    vec2 square = spot ? cone_to_square(light.normal, light.spread_scale, direction) : sphere_to_square(direction);
    float pdf = mixed_pdf(light, plain, choice.place, square, aimed, has_targets, choice);
    float forward, reach = INFINITY_DISTANCE;
    vec3 origin = light.position + sample_cross_section(light.radius, direction, choice.place, forward);
    if ((light.flags & LIGHT_SOFT) != 0u) forward = 0.0;
    if (within) {
        reach = 2.0 * forward;
        forward = -forward;
    }
    vec3 strength = within ? light.strength : radiant_strength(light, direction);
    return Emission(origin + forward * direction, NO_EMITTER, direction, strength / (part * pdf), pdf, reach);
}

// From a point of a surface, with the pdf by area that the point was chosen by.
Emission emit_from_surface(Light light, TrianglePoint point, EmissionChoice choice) {
    vec3 origin = point.position, normal = point.normal, radiance = point.radiance;
    EmitterNumber triangle = point.triangle;
    float cones = target_cones(origin);
    bool has_targets = cones > 0.0, both_sides = light.kind == LIGHT_MESH, narrow = light.spread_tangent > 0.0;
    vec3 direction;
    if (choice.aimed && has_targets)
        direction = sample_target_direction(origin, cones, choice.target, choice.direction);
    else if (narrow) direction = sample_cone(normal, 1.0 - light.cosine_cone, choice.direction);
    else {
        // Both sides shine: the lower half of the first number goes to the back.
        bool back = both_sides && choice.direction.x < 0.5;
        vec2 u = both_sides ? vec2(fract(2.0 * choice.direction.x), choice.direction.y) : choice.direction;
        direction = sample_cosine_hemisphere(back ? -normal : normal, u);
    }
    float cosine = dot(direction, normal);
    if (both_sides) cosine = abs(cosine);
    Emission none = Emission(origin, triangle, direction, vec3(0.0), 0.0, 0.0);
    // Rays do not see strands and points from within: what shone there would get out.
    bool within = both_sides && dot(direction, normal) < 0.0 && is_one_sided(emitter_set_code(triangle));
    if (cosine <= 0.0 || within) return none;
    float plain = both_sides ? cosine / (2.0 * PI) : cosine / PI;
    if (narrow) plain = cosine >= light.cosine_cone ? 1.0 / (2.0 * PI * (1.0 - light.cosine_cone)) : 0.0;
    bool front = dot(direction, normal) > 0.0;
    vec2 square = narrow ? cone_to_square(normal, 1.0 - light.cosine_cone, direction)
                         : hemisphere_to_square(front ? normal : -normal, direction);
    if (both_sides) square.x = 0.5 * (square.x + (front ? 1.0 : 0.0));
    vec2 place = light.kind == LIGHT_MESH ? vec2(choice.part, 0.0) : choice.place;
    float pdf = mixed_pdf(light, plain, place, square,
                          has_targets ? target_direction_pdf(origin, cones, direction) : 0.0, has_targets, choice);
    float tangent = sqrt(max(0.0, 1.0 - cosine * cosine)) / max(cosine, 1e-6);
    if (!both_sides) radiance *= spread_attenuation(light, tangent);
    return Emission(origin + (front ? point.ray_offset : -point.ray_offset) * normal, triangle, direction,
                    radiance * (cosine / (point.pdf * pdf)), pdf, INFINITY_DISTANCE);
}

#ifdef PORTALS
#include "photons/photon_emission/portals.glsl"
#endif
#ifdef EMISSIVE_MEDIA
#include "photons/photon_emission/media.glsl"
#endif

// Whether one number chooses the place from which a photon leaves: of an emissive triangle, or in a medium.
bool has_part(Light light) {
#ifdef EMISSIVE_MEDIA
    if (light.kind == LIGHT_MEDIUM) return true;
#endif
    return light.kind == LIGHT_MESH;
}

Emission emit_plain_photon(Light light, EmissionChoice choice) {
    if (light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT) return emit_from_point(light, choice);
#ifdef PORTALS
    if (light.kind == LIGHT_WORLD) return emit_from_world(light, choice);
#endif
#ifdef EMISSIVE_MEDIA
    if (light.kind == LIGHT_MEDIUM) return emit_from_medium(light, choice);
#endif
    if (light.kind == LIGHT_SUN || light.kind == LIGHT_WORLD) {
        vec3 direction, flux_density = light.strength;
        if (light.kind == LIGHT_SUN) direction = sample_cone(light.normal, 1.0 - light.cosine_cone, choice.direction);
        else {
            float pdf;
            vec3 toward = sample_world(choice.direction, pdf);
            direction = -toward;
            flux_density = world_radiance(toward) / pdf;
        }
        return emit_from_infinity(light, direction, flux_density, choice);
    }
    TrianglePoint point;
    if (light.kind == LIGHT_MESH) point = sample_emissive_triangle(choice.part, choice.place);
    else {
        vec2 place = light.kind == LIGHT_ELLIPSE ? sample_disk(choice.place) : 2.0 * choice.place - 1.0;
        point = TrianglePoint(light.position + place.x * light.axis_u + place.y * light.axis_v, light.normal,
                              NO_EMITTER, light.strength, 1.0 / light.area, 0.0);
    }
    return emit_from_surface(light, point, choice);
}

Emission emit_photon(Light light, EmissionChoice choice) {
    Emission emission = emit_plain_photon(light, choice);
    emission.flux *= emitted_factor(light, emission.origin - light.position, emission.direction);
    return emission;
}
