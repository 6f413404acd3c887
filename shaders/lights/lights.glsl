// SPDX-License-Identifier: GPL-3.0-or-later
// Light sources: samples of them from a point, and what a ray sees of them.

#include "common/iteration.glsl"
#include "lights/light_table.glsl"
#include "lights/environment.glsl"
#include "lights/light_maps.glsl"
#include "common/world_light.glsl"
#include "common/spherical_triangle.glsl"
#include "common/ray_kinds.glsl"
#include "lights/emissive_triangles.glsl"
// Fourth components: of an emissive triangle's second corner, the probability of choosing it among all of them.
readonly buffer Triangles;
#include EMITTERS "lights/one_level/traits.glsl"

#include <Lights>
#include <LightFlags>

// Directions from which the photons of the world leave: those of its light through portals have a table of their own.
DirectionTable directions_of(Light light) {
#ifdef PORTALS
    if ((light.flags & LIGHT_THROUGH_PORTALS) != 0u)
        return DirectionTable(iteration.portal_table, iteration.portal_width, iteration.portal_height);
#endif
    return world_table();
}

// Cycles' spot: a smooth step in the cosine, in the light's own (maybe scaled) space.
float spot_attenuation(Light light, vec3 direction) {
    vec3 local = vec3(dot(direction, light.axis_u), dot(direction, light.axis_v), dot(direction, light.normal));
    if (local.z <= 0.0) return 0.0;
    float cosine = local.z / length(local);
    float range = (1.0 - light.cosine_cone) * light.blend;
    if (range <= 0.0) return cosine > light.cosine_cone ? 1.0 : 0.0;
    float x = clamp((cosine - light.cosine_cone) / range, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

// Cycles' spread of area lights: linear in the tangent to the normal, zero beyond half the spread.
float spread_attenuation(Light light, float tangent) {
    if (light.spread_tangent <= 0.0) return 1.0;
    return max(0.0, (light.spread_tangent - tangent) * light.spread_scale);
}

// Toward a point that sees the light along to_light, of any length. The cosine has little precision for small angles.
float attenuation_toward(Light light, vec3 to_light) {
    return spread_attenuation(light, length(cross(to_light, light.normal)) / -dot(to_light, light.normal));
}

vec3 radiant_strength(Light light, vec3 direction) {
    return light.kind == LIGHT_SPOT ? light.strength * spot_attenuation(light, direction) : light.strength;
}

// In 1/sr, of shadow rays to the environment where no portals face the point.
float world_shadow_ray_pdf(vec3 direction) { return iteration.world_selection * world_pdf(direction); }

// By its selection probability.
uint choose_light(float u) {
    uint low = 0u, high = iteration.light_count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (lights[middle].selection_end > u) high = middle;
        else low = middle + 1u;
    }
    return low;
}

void triangle_corners(uint triangle, out vec3 v0, out vec3 v1, out vec3 v2) {
    v0 = triangle_vertices[3u * triangle].xyz;
    v1 = triangle_vertices[3u * triangle + 1u].xyz;
    v2 = triangle_vertices[3u * triangle + 2u].xyz;
}

// What varies is asked for later, where a place has been sampled (lights/emitters.comp).
vec3 sampled_radiance(EmissiveTriangle emissive) {
    return (emissive.traits & EMITTER_UNEVEN) != 0u ? vec3(1.0) : emissive.radiance;
}

#include EMITTERS "lights/one_level/emitters.glsl"

// --- direct light ---------------------------------------------------------------------------

// Light toward a point: radiance divided by the pdf in 1/sr, and that pdf (0 for lights without
// extent). weight 0: nothing arrives.
struct LightSample {
    vec3 direction;
    float distance;
    vec3 weight;
    EmitterNumber triangle;
    float pdf;
};

const LightSample NO_LIGHT_SAMPLE = LightSample(vec3(0.0, 0.0, 1.0), 0.0, vec3(0.0), NO_EMITTER, 0.0);

// Where a shadow ray to a light ends, meters: short of it by what rounding may move a surface that it lies in.
float shadow_ray_length(float distance) {
    const float ROUNDING = 1.0 / 524288.0, MOST = 1e-4;
    return distance - min(ROUNDING * (distance + iteration.scene_radius), MOST * distance);
}

// Surfaces are sampled by the solid angle that they have from the point: by area, what a surface gets from a
// light that it meets has no bound.

// The cone of a soft light's disk, which faces the point: one minus its cosine.
float soft_light_cone(Light light, vec3 to_center) {
    float distance = length(to_center), radius2 = light.radius * light.radius;
    float slant = sqrt(distance * distance + radius2);
    return radius2 / (slant * (slant + distance));
}

// From a point within a sphere to where it meets a direction; there it is seen, to every side, from within.
float far_side(Light light, vec3 to_center, vec3 direction) {
    float along = dot(to_center, direction);
    return along + sqrt(max(0.0, light.radius * light.radius - dot(to_center, to_center) + along * along));
}

// Within its sphere a light shines alike from all sides, a spot as well (Cycles).
LightSample sample_from_within(Light light, vec3 to_center, vec2 u) {
    vec3 direction = sample_sphere(u);
    return LightSample(direction, far_side(light, to_center, direction),
                       4.0 / (light.radius * light.radius) * light.strength, NO_EMITTER, 1.0 / (4.0 * PI));
}

// Toward a sun, a sphere, or the disk of a soft light that faces the point: a direction within a cone.
LightSample sample_cone_light(Light light, vec3 point, vec2 u) {
    LightSample result = NO_LIGHT_SAMPLE;
    bool sun = light.kind == LIGHT_SUN, soft = !sun && (light.flags & LIGHT_SOFT) != 0u;
    vec3 to_center = light.position - point;
    float distance2 = dot(to_center, to_center), radius2 = light.radius * light.radius, sine2 = radius2 / distance2;
    if (!sun && !soft && distance2 <= radius2) {
        if (light.radius > 0.0) return sample_from_within(light, to_center, u);
        return result;
    }
    float one_minus_cosine = sun    ? 1.0 - light.cosine_cone
                             : soft ? soft_light_cone(light, to_center)
                                    : sine2 / (1.0 + sqrt(1.0 - sine2));
    vec3 axis = sun    ? light.normal
                : soft ? to_center / max(length(to_center), 1e-20)
                       : to_center * inversesqrt(distance2);
    result.direction = sample_cone(axis, one_minus_cosine, u);
    if (sun) {
        result.direction = -result.direction;
        result.distance = INFINITY_DISTANCE;
        result.weight = light.strength;
        if (light.cosine_cone < 1.0) result.pdf = 1.0 / (2.0 * PI * (1.0 - light.cosine_cone));
        return result;
    }
    bool is_point = !soft && sine2 < 1e-7;
    if (is_point) result.direction = axis;
    result.weight = radiant_strength(light, -result.direction);
    if (is_point) {
        result.distance = sqrt(distance2) - light.radius;
        result.weight /= distance2;
        return result;
    }
    result.pdf = 1.0 / (2.0 * PI * one_minus_cosine);
    if (soft) {
        result.distance = length(to_center) / max(dot(result.direction, axis), 1e-6);
        result.weight *= 2.0 * one_minus_cosine / (light.radius * light.radius);
        return result;
    }
    float along = dot(to_center, result.direction), area = PI * light.radius * light.radius;
    result.distance = along - sqrt(max(0.0, light.radius * light.radius - (distance2 - along * along)));
    result.weight *= 2.0 * PI * one_minus_cosine / area;
    return result;
}

// A parallelogram is two triangles. Of an area light: itself, or what bounds the ellipse.
vec3 area_light_corner(Light light, float u, float v) { return light.position + u * light.axis_u + v * light.axis_v; }

vec2 area_light_solid_angles(Light light, vec3 point) {
    vec3 v0 = area_light_corner(light, 1.0, -1.0), v1 = area_light_corner(light, -1.0, 1.0);
    return vec2(triangle_solid_angle(point, v0, v1, area_light_corner(light, -1.0, -1.0)),
                triangle_solid_angle(point, v0, v1, area_light_corner(light, 1.0, 1.0)));
}

// Near an ellipse, a quarter of the parallelogram in vain is the lesser evil.
bool sampled_by_solid_angle(Light light, vec3 point) {
    vec3 offset = point - light.position;
    float size2 = dot(light.axis_u, light.axis_u) + dot(light.axis_v, light.axis_v);
    return light.kind == LIGHT_RECTANGLE || dot(offset, offset) < 2.0 * size2;
}

// Coordinates along both axes of an area light, which are not orthogonal where it is sheared.
vec2 area_light_coordinates(Light light, vec3 offset) {
    float uu = dot(light.axis_u, light.axis_u), uv = dot(light.axis_u, light.axis_v),
          vv = dot(light.axis_v, light.axis_v);
    float pu = dot(offset, light.axis_u), pv = dot(offset, light.axis_v);
    return vec2(pu * vv - pv * uv, pv * uu - pu * uv) / (uu * vv - uv * uv);
}

float pdf_by_area(Light light, vec3 to_light) {
    float distance2 = dot(to_light, to_light);
    return distance2 * sqrt(distance2) / (abs(dot(to_light, light.normal)) * light.area);
}

bool is_on_area_light(Light light, vec2 coordinates) {
    return light.kind == LIGHT_ELLIPSE ? dot(coordinates, coordinates) <= 1.0
                                       : max(abs(coordinates.x), abs(coordinates.y)) <= 1.0;
}

// A narrow spread leaves of an area light what lies on a disk around the point's foot on its plane, as Cycles'
// area_light_spread_clamp_light: the light becomes the least that holds this, the whole or a parallelogram, which is
// empty where nothing shines. True where the disk itself is to be sampled: by what shines from there, which pays where
// at most half of that misses the light, unless the disk is so wide that its rim is much farther away.
bool narrow_to_spread(inout Light light, vec3 point) {
    const float WIDEST_TANGENT = 2.0, MIN_WITHIN = 2.2;  // of the square around the disk, which has 4
    float radius = max(dot(point - light.position, light.normal), 0.0) * light.spread_tangent;
    float spanned = length(cross(light.axis_u, light.axis_v));
    vec2 foot = area_light_coordinates(light, point - light.position);
    vec2 reach = radius / spanned * vec2(length(light.axis_v), length(light.axis_u));
    vec2 low = max(foot - reach, -1.0), high = min(foot + reach, 1.0), extent = max(0.5 * (high - low), 0.0);
    float within = 4.0 * extent.x * extent.y * spanned;
    if (light.spread_tangent <= WIDEST_TANGENT && within > MIN_WITHIN * radius * radius) return true;
    if (within >= light.area) return false;
    light.kind = LIGHT_RECTANGLE;
    light.position = area_light_corner(light, 0.5 * (low.x + high.x), 0.5 * (low.y + high.y));
    light.axis_u *= extent.x;
    light.axis_v *= extent.y;
    return false;
}

// From the point to a place on the disk, by what shines from there: within r of its radius 3 r^2 - 2 r^3.
vec3 sample_spread_disk(Light light, vec3 point, vec2 u) {
    vec3 t, b;
    tangent_frame(light.normal, t, b);
    vec2 place = sample_disk(u);
    float fraction = clamp(dot(place, place), 1e-20, 1.0);
    place *= light.spread_tangent * (0.5 - sin(asin(1.0 - 2.0 * fraction) / 3.0)) * inversesqrt(fraction);
    return dot(point - light.position, light.normal) * (place.x * t + place.y * b - light.normal);
}

float spread_disk_pdf(Light light, vec3 to_light) {
    float height = -dot(to_light, light.normal), radius = height * light.spread_tangent;
    float straight_on = light.spread_tangent * light.spread_scale, distance2 = dot(to_light, to_light);
    return 3.0 * attenuation_toward(light, to_light) / (PI * radius * radius * straight_on) * distance2
           * sqrt(distance2) / height;
}

// Pdf in 1/sr with which sample_surface_light gives the direction to a place on an area light.
float area_light_pdf(Light light, vec3 point, vec3 to_light) {
    if (light.spread_tangent > 0.0 && narrow_to_spread(light, point)) return spread_disk_pdf(light, to_light);
    if (!sampled_by_solid_angle(light, point)) return pdf_by_area(light, to_light);
    vec2 angles = area_light_solid_angles(light, point);
    return angles.x + angles.y > 0.0 ? 1.0 / (angles.x + angles.y) : 0.0;
}

// Toward an emissive triangle, or an area light, which is two triangles that share an edge.
LightSample sample_surface_light(Light light, EmitterNumber emitter, vec3 point, vec2 u) {
    LightSample result;
    result.triangle = NO_EMITTER;
    bool mesh = light.kind == LIGHT_MESH;
    vec3 to_light, radiance = vec3(0.0), offset = light.position - point;
    Light part = light;
    if (!mesh && light.spread_tangent > 0.0 && narrow_to_spread(part, point)) {
        to_light = sample_spread_disk(light, point, u);
        bool hit = is_on_area_light(light, area_light_coordinates(light, to_light - offset));
        result.pdf = hit ? spread_disk_pdf(light, to_light) : 0.0;
    } else if (mesh || sampled_by_solid_angle(part, point)) {
        vec3 v0 = area_light_corner(part, 1.0, -1.0), v1 = area_light_corner(part, -1.0, 1.0),
             v2 = area_light_corner(part, -1.0, -1.0), other = area_light_corner(part, 1.0, 1.0);
        if (mesh) radiance = sampled_radiance(read_emitter(emitter, result.triangle, v0, v1, v2));
        vec2 angles = vec2(triangle_solid_angle(point, v0, v1, v2), 0.0);
        if (!mesh) angles.y = triangle_solid_angle(point, v0, v1, other);
        float total = angles.x + angles.y, chosen = u.x * total;
        result.pdf = total <= 0.0 ? 0.0 : 1.0 / total;
        bool first = mesh || chosen < angles.x;
        if (!mesh) u.x = first ? chosen / angles.x : (chosen - angles.x) / angles.y;
        to_light = sample_spherical_triangle(point, v0, v1, first ? v2 : other, first ? angles.x : angles.y, u);
        vec2 at = area_light_coordinates(light, to_light - offset);
        if (light.kind == LIGHT_ELLIPSE && dot(at, at) > 1.0) result.pdf = 0.0;
    } else {
        vec2 place = sample_disk(u);
        to_light = offset + place.x * light.axis_u + place.y * light.axis_v;
        result.pdf = pdf_by_area(light, to_light);
    }
    if (!mesh) radiance = light.strength * attenuation_toward(light, to_light);
    result.distance = length(to_light);
    result.direction = to_light / result.distance;
    result.weight = radiance / result.pdf;
    bool arrives =
        (mesh || dot(point - light.position, light.normal) > 0.0) && result.pdf > 0.0 && result.distance > 0.0;
    if (!arrives) return NO_LIGHT_SAMPLE;
    return result;
}

#ifdef PORTALS
#include "lights/portals.glsl"

// In place of the world the portal that a shadow ray to it is to pass, or the light with the directions of what passes
// portals, as mixed_world_pdf has it.
uint enter_portal(inout Light light, vec3 point, inout float u) {
    uint portal = NO_PORTAL;
    if (light.kind == LIGHT_WORLD) portal = choose_portal(point, u);
    if (portal == NO_PORTAL) return NO_PORTAL;
    float through = iteration.portal_fraction, by_table = iteration.portal_table_fraction;
    bool passes = u < through, takes_table = u < through + by_table;
    float fraction = passes ? through : takes_table ? by_table : 1.0 - through - by_table;
    u = clamp((u - (passes ? 0.0 : takes_table ? through : through + by_table)) / fraction, 0.0, 0.99999994);
    if (passes) light = portal_at(portal);
    else if (takes_table) light.flags |= LIGHT_THROUGH_PORTALS;
    return passes ? portal : NO_PORTAL;
}

// What was sampled of the world, or of a portal, as a sample of the world by both ways.
LightSample world_through_portals(LightSample result, uint portal, vec3 point) {
    if (!(result.pdf > 0.0)) return NO_LIGHT_SAMPLE;
    result.distance = INFINITY_DISTANCE;
    result.pdf = mixed_world_pdf(view_portals(point, result.direction, portal), result.direction);
    result.weight = world_radiance(result.direction) / result.pdf;
    return result;
}
#endif

// Surfaces first, since they need most registers: what else there is would be kept beside.
LightSample sample_light_at_one_meter(Light light, EmitterNumber emitter, vec3 point, vec2 u) {
    bool cone = light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT || light.kind == LIGHT_SUN;
    if (!cone && light.kind != LIGHT_WORLD) return sample_surface_light(light, emitter, point, u);
    if (cone) return sample_cone_light(light, point, u);
    LightSample result = NO_LIGHT_SAMPLE;
    result.direction = sample_directions(directions_of(light), u, result.pdf);
    result.distance = INFINITY_DISTANCE;
    result.weight = world_radiance(result.direction) / result.pdf;
    return result;
}

bool is_area_light(Light light) { return light.kind == LIGHT_RECTANGLE || light.kind == LIGHT_ELLIPSE; }

// Whether the normals of a light are those of a sphere, and not the light's direction.
bool is_sphere(Light light) {
    return light.kind <= LIGHT_SPOT && light.radius > 0.0 && (light.flags & LIGHT_SOFT) == 0u;
}

// What the nodes of a light give where light leaves it. from_center: from the light's position to there.
vec3 emitted_factor(Light light, vec3 from_center, vec3 direction) {
    if (light.map_shape == 0u) return vec3(1.0);
    return light_factor(light, direction, is_sphere(light) ? normalize(from_center) : direction,
                        is_area_light(light) ? area_light_coordinates(light, from_center) : vec2(0.0));
}

// Evenly on the disk of a sphere across a direction, from its center; forward: to the sphere from there.
vec3 sample_cross_section(float radius, vec3 direction, vec2 u, out float forward) {
    vec3 t, b;
    tangent_frame(direction, t, b);
    vec2 disk = sample_disk(u);
    forward = radius * sqrt(max(0.0, 1.0 - dot(disk, disk)));
    return radius * (disk.x * t + disk.y * b);
}

// Where the half of a sphere that faces a direction is met along it, evenly seen: from the sphere's center.
vec3 sample_facing_half(float radius, vec3 direction, vec2 u) {
    float forward;
    vec3 place = sample_cross_section(radius, direction, u, forward);
    return place + forward * direction;
}

// Of the emissive meshes: of one triangle, by its number among emissive_triangles[].
LightSample sample_light(Light light, EmitterNumber emitter, vec3 point, vec2 u) {
#ifdef PORTALS
    bool world = light.kind == LIGHT_WORLD;
    uint portal = enter_portal(light, point, u.x);
#endif
    LightSample result = sample_light_at_one_meter(light, emitter, point, u);
#ifdef PORTALS
    if (world) result = world_through_portals(result, portal, point);
#endif
    vec3 from_center = point + result.distance * result.direction - light.position;
    if (result.pdf == 0.0 && is_sphere(light)) from_center = sample_facing_half(light.radius, -result.direction, u);
    result.weight *= distance_factor(light, result.distance) * emitted_factor(light, from_center, -result.direction);
    return result;
}

// Of the emissive meshes: of any triangle, by its probability.
LightSample sample_whole_light(Light light, vec3 point, float u_choice, vec2 u) {
    bool mesh = light.kind == LIGHT_MESH;
    float probability = 1.0;
    EmitterNumber emitter = mesh ? choose_emitter(u_choice, u, probability) : in_world(0u);
    LightSample result = sample_light(light, emitter, point, u);
    if (mesh) {
        result.pdf *= probability;
        result.weight /= probability;
    }
    return result;
}

// --- lights that a specular path meets ----------------------------------------------------------

// MIS weight of a light met by scattering, with a pdf, when shadow rays find it with another.
// Without a pdf only scattering finds it.
float scatter_mis_weight(float scatter_pdf, float light_pdf) {
    return scatter_pdf > 0.0 ? 1.0 - power_heuristic(light_pdf, scatter_pdf) : 1.0;
}

// Whether gathering rays, which set out after so many bounces, share a light with shadow rays. These alone find what
// has shadows of its own, and keep to the light's limit of bounces.
bool is_shared_light(Light light, uint bounces) {
    return iteration.gathers_lights != 0u && light.link == 0u && bounces <= light.max_bounces;
}

// Pdf in 1/sr with which sample_light gives a direction from the point to an emissive triangle.
float emissive_triangle_pdf(vec3 point, uint triangle) {
    vec3 v0, v1, v2;
    triangle_corners(triangle, v0, v1, v2);
    float solid_angle = triangle_solid_angle(point, v0, v1, v2);
    return solid_angle > 0.0 ? 1.0 / solid_angle : 0.0;
}

// Radiance of a light object without nodes that a ray passes within its length, where it does, and the pdf in
// 1/sr with which sample_light gives the ray's direction.
vec3 intersected_plain_light(Light light, vec3 origin, vec3 direction, float maximum_distance, out float distance,
                             out float pdf) {
    pdf = distance = 0.0;
    if (light.kind == LIGHT_SUN) {
        float solid_angle = 2.0 * PI * (1.0 - light.cosine_cone);
        if (maximum_distance < INFINITY_DISTANCE || solid_angle <= 0.0
            || -dot(direction, light.normal) < light.cosine_cone)
            return vec3(0.0);
        pdf = 1.0 / solid_angle;
        return light.strength / solid_angle;
    }
    if (light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT) {
        if (light.radius <= 0.0) return vec3(0.0);
        bool within = false;
        vec3 to_center = light.position - origin;
        float distance2 = dot(to_center, to_center), radius2 = light.radius * light.radius;
        if ((light.flags & LIGHT_SOFT) != 0u) {
            distance = soft_light_distance(light, origin, direction);
            pdf = 1.0 / (2.0 * PI * soft_light_cone(light, to_center));
        } else {
            float along = dot(to_center, direction);
            vec3 off_axis = to_center - along * direction;
            float under = radius2 - dot(off_axis, off_axis);
            within = distance2 <= radius2;
            if (!within && (under < 0.0 || along <= 0.0)) return vec3(0.0);
            distance = within ? far_side(light, to_center, direction) : along - sqrt(under);
            float sine2 = min(radius2 / distance2, 1.0);
            // sample_light takes smaller lights for points, which no ray meets
            pdf = within ? 1.0 / (4.0 * PI) : sine2 < 1e-7 ? 0.0 : (1.0 + sqrt(1.0 - sine2)) / (2.0 * PI * sine2);
        }
        if (distance <= 0.0 || distance >= maximum_distance) return vec3(0.0);
        return (within ? light.strength : radiant_strength(light, -direction)) / (PI * radius2);
    }
    if (!is_area_light(light)) return vec3(0.0);
    float cosine = -dot(direction, light.normal);
    if (cosine <= 0.0) return vec3(0.0);
    distance = dot(origin - light.position, light.normal) / cosine;
    if (distance <= 0.0 || distance >= maximum_distance) return vec3(0.0);
    vec2 at = area_light_coordinates(light, origin + distance * direction - light.position);
    if (!is_on_area_light(light, at)) return vec3(0.0);
    vec3 to_light = distance * direction;
    pdf = area_light_pdf(light, origin, to_light);
    return light.strength * attenuation_toward(light, to_light);
}

// The same for a light that may have nodes.
vec3 intersected_radiance(Light light, vec3 origin, vec3 direction, float maximum_distance, out float distance,
                          out float pdf) {
    vec3 radiance = intersected_plain_light(light, origin, direction, maximum_distance, distance, pdf);
    vec3 from_center = origin + distance * direction - light.position;
    return radiance * distance_factor(light, distance) * emitted_factor(light, from_center, -direction);
}
