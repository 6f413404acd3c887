// SPDX-License-Identifier: GPL-3.0-or-later
// The lights, and whose photons are whose.

#include "common/iteration.glsl"
#include <Light>
readonly buffer Lights { Light lights[]; };

// Lights hold consecutive ranges of the photons.
uint light_of(uint photon) {
    uint low = 0u, high = iteration.light_count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (lights[middle].first_photon <= photon) low = middle;
        else high = middle - 1u;
    }
    return low;
}

// Where a ray meets the disk of a soft light that faces the ray's origin; 0 where it does not.
float soft_light_distance(Light light, vec3 origin, vec3 direction) {
    vec3 to_center = light.position - origin;
    float distance = dot(to_center, to_center) / dot(direction, to_center);
    vec3 place = distance * direction - to_center;
    return distance > 0.0 && dot(place, place) <= light.radius * light.radius ? distance : 0.0;
}
