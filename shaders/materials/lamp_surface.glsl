// SPDX-License-Identifier: GPL-3.0-or-later
// A lamp as its nodes see it at a pixel of its map, as in Cycles: a sphere's or an area light's normal, else the
// direction of the light. Needs the lamp members of the parameters.

#include <MapShapes>
#include <LampKinds>

vec2 sphere_coordinates(vec3 n) {
    float around = n.x == 0.0 && n.y == 0.0 ? 0.0 : 0.5 - atan(n.x, n.y) / (2.0 * PI);
    return vec2(around, 1.0 - acos(clamp(n.z, -1.0, 1.0)) / PI);
}

// A sun's disc, seen from where it shines to: even in the sine of half the angle.
vec2 disc_coordinates(vec2 at, float tangent) {
    float r = length(at);
    if (r <= 0.0) return vec2(0.5);
    return 0.5 - 0.5 * at / r * sin(0.5 * atan(r * tangent)) / sin(0.5 * atan(tangent));
}

Surface lamp_surface(vec2 pixel, vec3 map_direction) {
    vec2 at = 2.0 * pixel - 1.0;
    vec3 u = parameters.lamp_u, v = parameters.lamp_v, direction = map_direction;
    bool places = parameters.lamp_shape == MAP_PLACES, cone = parameters.lamp_shape == MAP_CONE;
    if (places) direction = parameters.lamp_normal;
    if (cone) direction = normalize(parameters.lamp_normal + at.x * u + at.y * v);
    Surface lamp = Surface(parameters.lamp_position + parameters.lamp_radius * direction, direction, direction,
                           direction, pixel,
                           vec3(0.0), NO_TRIANGLE, 0u, false, RAY_DIFFUSE, parameters.ray_length, 0u);
    if (parameters.lamp_kind == LAMP_AREA) {
        lamp.normal = lamp.geometric = parameters.lamp_normal;
        lamp.position = parameters.lamp_position + (places ? at.x * u + at.y * v : vec3(0.0));
        lamp.uv = places ? pixel : vec2(0.5);
    } else if (parameters.lamp_kind == LAMP_SUN) {
        lamp.position = direction;
        lamp.uv = disc_coordinates(at, length(u));
    } else if (parameters.lamp_kind == LAMP_SUN_OF_A_WORLD) {
        lamp.position = -direction;
        lamp.instance = NO_INSTANCE;
    } else if (!cone) lamp.uv = sphere_coordinates(normalize(direction_to_object(lamp, direction)));
    lamp.barycentrics = vec3(lamp.uv, 1.0 - lamp.uv.x - lamp.uv.y);
    return lamp;
}
