// SPDX-License-Identifier: GPL-3.0-or-later
// A light as its nodes see it at a pixel of its map, as in Cycles: a sphere's or an area light's normal, else the
// direction of the light. Needs the light members of the parameters.

#include <MapShapes>
#include <LightSurfaceKinds>

vec2 sphere_coordinates(vec3 n) {
    float around = n.x == 0.0 && n.y == 0.0 ? 0.0 : 0.5 - atan(n.x, n.y) / (2.0 * PI);
    return vec2(around, 1.0 - acos(clamp(n.z, -1.0, 1.0)) / PI);
}

// A sun's disk, seen from where it shines to: even in the sine of half the angle.
vec2 disk_coordinates(vec2 at, float tangent) {
    float r = length(at);
    if (r <= 0.0) return vec2(0.5);
    return 0.5 - 0.5 * at / r * sin(0.5 * atan(r * tangent)) / sin(0.5 * atan(tangent));
}

Surface light_surface(vec2 pixel, vec3 map_direction) {
    vec2 at = 2.0 * pixel - 1.0;
    vec3 u = parameters.light_u, v = parameters.light_v, direction = map_direction;
    bool places = parameters.light_shape == MAP_PLACES, cone = parameters.light_shape == MAP_CONE;
    if (places) direction = parameters.light_normal;
    if (cone) direction = normalize(parameters.light_normal + at.x * u + at.y * v);
    Surface surface =
        Surface(parameters.light_position + parameters.light_radius * direction, direction, direction, direction, pixel,
                vec3(0.0), vec3(0.0), NO_TRIANGLE, 0u, false, RAY_DIFFUSE, parameters.ray_length, 0u, 0u, 0u, 0u);
    if (parameters.light_kind == LIGHT_SURFACE_AREA) {
        surface.normal = surface.geometric = parameters.light_normal;
        surface.position = parameters.light_position + (places ? at.x * u + at.y * v : vec3(0.0));
        surface.uv = places ? pixel : vec2(0.5);
    } else if (parameters.light_kind == LIGHT_SURFACE_SUN) {
        surface.position = direction;
        surface.uv = disk_coordinates(at, length(u));
    } else if (parameters.light_kind == LIGHT_SURFACE_SUN_OF_A_WORLD) {
        surface.position = -direction;
        surface.instance = NO_INSTANCE;
    } else if (!cone) surface.uv = sphere_coordinates(normalize(direction_to_object(surface, direction)));
    surface.barycentrics = vec3(surface.uv, 1.0 - surface.uv.x - surface.uv.y);
    return surface;
}
