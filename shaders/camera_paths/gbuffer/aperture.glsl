// SPDX-License-Identifier: GPL-3.0-or-later
// The opening of a thin lens. The includer declares the storage block of the camera.
#include "common/sampling.glsl"

// Uniform over a regular polygon with corners at distance 1 and the middle of an edge at an angle of `turn`.
vec2 sample_polygon(uint corners, float turn, vec2 u) {
    float sides = float(corners), side = min(floor(u.x * sides), sides - 1.0);
    float outward = sqrt(u.x * sides - side);
    float middle = turn + 2.0 * PI * side / sides, half_angle = PI / sides;
    // From the middle of the edge along it.
    float along = (2.0 * u.y - 1.0) * sin(half_angle);
    vec2 axis = vec2(cos(middle), sin(middle));
    return outward * (cos(half_angle) * axis + along * vec2(-axis.y, axis.x));
}

// Meters to the right and upward; (0, 0) for a pinhole.
vec2 aperture_point(vec2 u) {
    vec2 point = camera.aperture_blades < 3u ? sample_disk(u)
                                             : sample_polygon(camera.aperture_blades, camera.aperture_rotation, u);
    point.x /= camera.aperture_ratio;
    return camera.aperture_radius * point;
}
