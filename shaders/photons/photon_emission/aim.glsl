// SPDX-License-Identifier: GPL-3.0-or-later
// A part of a light's photons is aimed at the objects that make caustics, so that a small glass in a
// large room gets its part. The pdf of both ways together divides the flux (balance heuristic,
// Veach 1997, section 9.2), so aiming moves noise and no energy. Needs the member target_count.

#include "common/iteration.glsl"
readonly buffer Targets { vec4 targets[]; };  // bounding spheres

// One photon of so many is aimed. The world lights rooms through their windows only: it keeps more
// photons for that.
uint aiming_period(Light light) { return light.kind == LIGHT_WORLD ? 4u : 2u; }

// Of its photons. What leaves through portals has its aim.
uint aimed_photons(Light light) {
    bool aims = parameters.target_count > 0u && (light.flags & LIGHT_THROUGH_PORTALS) == 0u;
    return aims ? light.photon_count / aiming_period(light) : 0u;
}

// The fraction that this rule gives to just so many photons keeps the estimate exact.
float aimed_fraction(Light light) { return float(aimed_photons(light)) / float(max(light.photon_count, 1u)); }

// One minus the cosine of the cone under which a sphere is seen; 0 from inside, where it is no target.
float target_cone(vec4 target, vec3 from) {
    vec3 to_center = target.xyz - from;
    float sine2 = target.w * target.w / dot(to_center, to_center);
    return sine2 < 1.0 ? sine2 / (1.0 + sqrt(1.0 - sine2)) : 0.0;
}

// Solid angle of all targets from a point, over 2 pi; overlaps count twice.
float target_cones(vec3 from) {
    float sum = 0.0;
    for (uint k = 0u; k < parameters.target_count; ++k) sum += target_cone(targets[k], from);
    return sum;
}

// Even in solid angle among the targets' cones.
vec3 sample_target_direction(vec3 from, float cones, float u_target, vec2 u) {
    float rest = u_target * cones;
    vec3 direction = vec3(0.0, 0.0, 1.0);
    for (uint k = 0u; k < parameters.target_count; ++k) {
        float cone = target_cone(targets[k], from);
        if (cone <= 0.0) continue;
        direction = sample_cone(normalize(targets[k].xyz - from), cone, u);
        if (rest < cone) break;
        rest -= cone;
    }
    return direction;
}

// Its pdf in 1/sr.
float target_direction_pdf(vec3 from, float cones, vec3 direction) {
    float count = 0.0;
    for (uint k = 0u; k < parameters.target_count; ++k) {
        float cone = target_cone(targets[k], from);
        if (cone > 0.0 && dot(normalize(targets[k].xyz - from), direction) >= 1.0 - cone) count += 1.0;
    }
    return count / (2.0 * PI * cones);
}

// Squared radii of all targets: their shadows' area over pi in parallel light.
float target_shadows() {
    float sum = 0.0;
    for (uint k = 0u; k < parameters.target_count; ++k) sum += targets[k].w * targets[k].w;
    return sum;
}

// A point, relative to the scene's center, on the plane through it across a direction (axes t and b),
// even among the targets' shadows.
vec2 sample_target_shadow(vec3 t, vec3 b, float shadows, float u_target, vec2 u) {
    float rest = u_target * shadows;
    vec2 place = vec2(0.0);
    for (uint k = 0u; k < parameters.target_count; ++k) {
        vec3 offset = targets[k].xyz - iteration.scene_center;
        place = vec2(dot(offset, t), dot(offset, b)) + targets[k].w * sample_disk(u);
        float shadow = targets[k].w * targets[k].w;
        if (rest < shadow) break;
        rest -= shadow;
    }
    return place;
}

// Its pdf in 1/m^2.
float target_shadow_pdf(vec3 t, vec3 b, float shadows, vec2 place) {
    float count = 0.0;
    for (uint k = 0u; k < parameters.target_count; ++k) {
        vec3 offset = targets[k].xyz - iteration.scene_center;
        vec2 aside = place - vec2(dot(offset, t), dot(offset, b));
        if (dot(aside, aside) <= targets[k].w * targets[k].w) count += 1.0;
    }
    return count / (PI * shadows);
}
