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

// Light Falloff nodes: what a light gives may grow with a power of the distance, and be weakened near it.
float distance_factor(Light light, float distance) {
    float smoothed = light.smoothing > 0.0 ? distance * distance / (light.smoothing + distance * distance) : 1.0;
    return light.falloff == 0.0 ? smoothed : smoothed * pow(max(distance, 1e-6), light.falloff);
}

// Where a ray meets the disk of a soft light that faces the ray's origin; 0 where it does not.
float soft_light_distance(Light light, vec3 origin, vec3 direction) {
    vec3 to_center = light.position - origin;
    float distance = dot(to_center, to_center) / dot(direction, to_center);
    vec3 place = distance * direction - to_center;
    return distance > 0.0 && dot(place, place) <= light.radius * light.radius ? distance : 0.0;
}
