// SPDX-License-Identifier: GPL-3.0-or-later
// Eyes that stand to the side of each direction in which they look, as in Cycles. Needs PrimaryRaysParameters.

// How much of the offset is left at an altitude, radians.
float pole_merge_factor(float altitude) {
    vec2 merge = parameters.pole_merge;
    if (!(merge.y > 0.0) || altitude <= merge.x) return 1.0;
    return altitude > merge.y ? 0.0 : cos(0.5 * PI * (altitude - merge.x) / (merge.y - merge.x));
}

// The ray of an eye in place of a ray of the camera, in the world. Up is the camera's in a panorama, else the world's.
Ray spherical_stereo_ray(Ray ray, float start_distance) {
    vec3 up = camera.projection > PROJECTION_ORTHOGRAPHIC ? camera.up : vec3(0.0, 0.0, 1.0);
    vec3 beside = cross(ray.direction, up);
    if (!(dot(beside, beside) > 0.0)) return ray;
    float altitude = abs(asin(clamp(dot(ray.direction, up), -1.0, 1.0)));
    vec3 offset = parameters.stereo_offset * pole_merge_factor(altitude) * normalize(beside);
    vec3 lens = ray.origin - start_distance * ray.direction + offset;
    if (parameters.convergence_distance > 0.0)
        ray.direction = normalize(parameters.convergence_distance * ray.direction - offset);
    ray.origin = lens + start_distance * ray.direction;
    return ray;
}
