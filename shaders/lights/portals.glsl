// SPDX-License-Identifier: GPL-3.0-or-later
// Portals say where the world's light comes in. They are area lights behind the last light of the table, which face the
// side that they are of use to (rppm_addon/integrator/lights/portals.py).

#include "common/iteration.glsl"
const uint NO_PORTAL = 0xffffffffu;

Light portal_at(uint portal) { return lights[iteration.light_count + portal]; }

// In sr, as seen from a point; of an ellipse that of the parallelogram around it; 0 from behind.
float portal_solid_angle(Light portal, vec3 point) {
    if (!(dot(point - portal.position, portal.normal) > 0.0)) return 0.0;
    vec2 angles = area_light_solid_angles(portal, point);
    return angles.x + angles.y;
}

// One of the portals by its solid angle; NO_PORTAL where none faces the point. u: as of reservoir_accept.
uint choose_portal(vec3 point, inout float u) {
    uint chosen = NO_PORTAL;
    float total = 0.0;
    for (uint k = 0u; k < iteration.portal_count; ++k) {
        float angle = portal_solid_angle(portal_at(k), point);
        if (!(angle > 0.0)) continue;
        total += angle;
        if (reservoir_accept(angle, total, u)) chosen = k;
    }
    return chosen;
}

// What is asked of portals from a point: the solid angles of those that face it, and the pdf in 1/sr with which
// directions through them are taken; 0 of one that passes none. sampled: the portal that the direction was taken for.
struct PortalView {
    float solid_angle;
    float pdf;
};

PortalView view_portals(vec3 point, vec3 direction, uint sampled) {
    PortalView view = PortalView(0.0, 0.0);
    for (uint k = 0u; k < iteration.portal_count; ++k) {
        Light portal = portal_at(k);
        float angle = portal_solid_angle(portal, point);
        if (!(angle > 0.0)) continue;
        view.solid_angle += angle;
        float cosine = -dot(direction, portal.normal);
        vec3 offset = point - portal.position;
        vec3 to_portal = dot(offset, portal.normal) / max(cosine, 1e-20) * direction;
        // Rounding must not take a direction for one that misses its own portal.
        bool passes = k == sampled
                      || (cosine > 0.0 && is_on_area_light(portal, area_light_coordinates(portal, offset + to_portal)));
        if (passes) view.pdf += sampled_by_solid_angle(portal, point) ? 1.0 : angle * pdf_by_area(portal, to_portal);
    }
    view.pdf /= max(view.solid_angle, 1e-30);
    return view;
}

// Pdf of shadow rays to the world: where portals face the point, by these, by what of the world's map passes portals,
// and for other openings by the map itself.
float mixed_world_pdf(PortalView view, vec3 direction) {
    float by_map = world_pdf(direction), through = iteration.portal_fraction;
    if (!(view.solid_angle > 0.0)) return by_map;
    float by_table = iteration.portal_table_fraction, pdf = through * view.pdf + (1.0 - through - by_table) * by_map;
    Light portals = lights[iteration.portal_light];
    return by_table > 0.0 ? pdf + by_table * table_pdf(directions_of(portals), direction) : pdf;
}

// What the world may give at a point, W/m^2, less than what it gives in the open where portals face the point.
// by_map: where portals do not.
float portal_irradiance(vec3 point, float by_map) {
    float angle = view_portals(point, vec3(0.0), NO_PORTAL).solid_angle;
    float through = iteration.portal_fraction + iteration.portal_table_fraction;
    float seen = mix(1.0, min(angle / (2.0 * PI), 1.0), through);
    return angle > 0.0 ? iteration.environment_irradiance * seen : by_map;
}
