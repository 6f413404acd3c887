// SPDX-License-Identifier: GPL-3.0-or-later
// The three-dimensional kernel of photons in media, 15 (1 - x^2) / (8 pi), whose integral over the unit ball is 1, and
// the part of it that lies in the medium: beyond a boundary there are no photons. The includer includes
// materials/medium.glsl and declares the block Triangles before.

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

// The part beyond the surfaces at which a ray begins and ends, as if they were planes; position: at so many meters from
// the beginning and the end of the ray.
float kernel_beyond_surfaces(Ray ray, Closure end, float distance, float radius) {
    float beyond = 0.0;
    if (ray.source_triangle != NO_TRIANGLE) {
        vec3 v0 = triangle_vertices[3u * ray.source_triangle].xyz;
        vec3 e1 = triangle_vertices[3u * ray.source_triangle + 1u].xyz - v0,
             e2 = triangle_vertices[3u * ray.source_triangle + 2u].xyz - v0;
        beyond += kernel_beyond_plane(abs(dot(normalize(cross(e1, e2)), ray.direction)) * distance / radius);
    }
    if (closure_hit(end)) {
        float cosine = abs(dot(unpack_unit_vector(end.geometric_normal), ray.direction));
        beyond += kernel_beyond_plane(cosine * (end.distance - distance) / radius);
    }
    // A medium may go on behind a surface that only passes light.
    return min(beyond, 0.5);
}

// Most that the density at a point is raised over the kernel's mean.
const float MOST_RISE = 3.0;

// The scattering coefficient at a point over its mean in the kernel, by channel. Points at the cube's corners have the
// kernel's second moment.
vec3 scattering_over_mean(uint flags, vec3 position, vec3 direction, vec3 scattering, float radius) {
    const float CORNER = 0.37796447;  // sqrt(1 / 7)
    vec3 mean = vec3(0.0);
    for (uint k = 0u; k < 8u; ++k) {
        vec3 corner = vec3(k & 1u, (k >> 1u) & 1u, k >> 2u) * 2.0 - 1.0;
        mean += path_medium(flags, PlaceOnRay(position + CORNER * radius * corner, direction, 0.0)).scattering;
    }
    return clamp(scattering / max(mean / 8.0, vec3(1e-30)), vec3(0.0), vec3(MOST_RISE));
}
