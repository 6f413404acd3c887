// SPDX-License-Identifier: GPL-3.0-or-later
// The three-dimensional kernel of photons in media, 15 (1 - x^2) / (8 pi), whose integral over the unit ball is 1, and
// the part of it that lies in the medium: beyond a boundary there are no photons. The includer includes
// materials/medium.glsl before.

float photon_kernel(float distance2, float radius) {
    float inverse = 1.0 / radius;
    return 15.0 / (8.0 * PI) * (1.0 - distance2 * inverse * inverse) * inverse * inverse * inverse;
}

// The part of the kernel beyond a plane, by the plane's distance over the radius.
float kernel_beyond_plane(float height) {
    if (height >= 1.0) return 0.0;
    float h2 = height * height;
    return 0.5 - 15.0 / 16.0 * height * (1.0 - h2 * (2.0 / 3.0 - 0.2 * h2));
}

// Most of the kernel that lies beyond both surfaces of a thin layer.
const float MOST_BEYOND = 0.75;

// The part beyond the surfaces at which a ray in media begins and ends, as if they were planes, where the media end
// there as well; distance: of the kernel's center from the beginning, meters.
float kernel_beyond_surfaces(Ray ray, MediumVertex segment, float distance, float radius) {
    float beyond = 0.0;
    if (segment.near_loss > 0.0) {
        float cosine = abs(dot(unpack_unit_vector(segment.near_normal), ray.direction));
        beyond += segment.near_loss * kernel_beyond_plane((segment.near_height + cosine * distance) / radius);
    }
    if (segment.far_loss > 0.0) {
        float cosine = abs(dot(unpack_unit_vector(segment.far_normal), ray.direction));
        beyond += segment.far_loss * kernel_beyond_plane(cosine * (segment.far - distance) / radius);
    }
    return min(beyond, MOST_BEYOND);
}

// Most that the density at a point is raised over the kernel's mean.
const float MOST_RISE = 3.0;

// A point beyond a plane, mirrored to this side of it. depth: of the point on this side, meters; normal: of the plane.
vec3 mirrored_inside(vec3 point, vec3 normal, float depth) {
    return depth < 0.0 ? point - 2.0 * depth * normal : point;
}

// The scattering coefficient at a point of a segment over its mean in the part of the kernel that lies in the media, by
// channel. Points at the cube's corners have the kernel's second moment; those beyond the surfaces at which the media
// end are mirrored.
vec3 scattering_over_mean(uint flags, Ray ray, MediumVertex segment, float distance, vec3 scattering, float radius) {
    const float CORNER = 0.37796447;  // sqrt(1 / 7)
    vec3 mean = vec3(0.0), position = ray.origin + distance * ray.direction;
    vec3 near = unpack_unit_vector(segment.near_normal), far = unpack_unit_vector(segment.far_normal);
    near *= dot(near, ray.direction) < 0.0 ? -1.0 : 1.0;
    far *= dot(far, ray.direction) < 0.0 ? 1.0 : -1.0;
    float near_height = segment.near_height + dot(near, ray.direction) * distance,
          far_height = -dot(far, ray.direction) * (segment.far - distance);
    for (uint k = 0u; k < 8u; ++k) {
        vec3 corner = CORNER * radius * (vec3(k & 1u, (k >> 1u) & 1u, k >> 2u) * 2.0 - 1.0);
        if (segment.near_loss > 0.0) corner = mirrored_inside(corner, near, near_height + dot(corner, near));
        if (segment.far_loss > 0.0) corner = mirrored_inside(corner, far, far_height + dot(corner, far));
        mean += path_medium(flags, PlaceOnRay(position + corner, ray.direction, 0.0)).scattering;
    }
    return clamp(scattering / max(mean / 8.0, vec3(1e-30)), vec3(0.0), vec3(MOST_RISE));
}
