// SPDX-License-Identifier: GPL-3.0-or-later
// What the nodes of lights give by place or direction (integrator/lights/light_maps.py).

uniform sampler2D light_maps;

#include <MapShapes>

// A factor of the light's strength. direction: away from the light; normal: of a sphere where the light leaves it;
// place: on an area light, from -1 to 1.
vec3 light_factor(Light light, vec3 direction, vec3 normal, vec2 place) {
    if (light.map_shape == 0u) return vec3(1.0);
    vec2 at = direction_to_equirectangular(light.map_shape == MAP_NORMALS ? normal : direction);
    if (light.map_shape == MAP_PLACES) at = 0.5 + 0.5 * place;
    if (light.map_shape == MAP_CONE) {
        vec3 local = vec3(dot(direction, light.axis_u), dot(direction, light.axis_v), dot(direction, light.normal));
        at = 0.5 + 0.5 * local.xy / (max(local.z, 1e-6) * light.map_extent);
    }
    return textureLod(light_maps, light.map.xy + clamp(at, 0.0, 1.0) * light.map.zw, 0.0).rgb;
}
