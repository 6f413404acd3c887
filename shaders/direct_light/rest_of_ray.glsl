// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow rays behind the surfaces that they pass.

#include <Ray>
#include "common/constants.glsl"
#include "common/geometry.glsl"

const float NO_REACH = 1e-30;  // of a ray that is traced and meets nothing

// The rest of a ray, from behind a surface to the same end. triangle: of the surface.
Ray rest_of_ray(Ray ray, vec3 origin, uint triangle) {
    Ray rest = Ray(origin, triangle, ray.direction, INFINITY_DISTANCE);
    if (!(ray.maximum_distance < INFINITY_DISTANCE)) return rest;
    vec3 to_end = ray.origin + ray.maximum_distance * ray.direction - origin;
    // A surface may lie nearer to the end than rays begin off it: there is nothing in between.
    rest.maximum_distance = max(dot(to_end, ray.direction), NO_REACH);
    if (rest.maximum_distance > NO_REACH) rest.direction = normalize(to_end);
    return rest;
}
