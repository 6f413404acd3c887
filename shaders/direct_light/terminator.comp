#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Where a smooth surface is made of flat triangles, shadow rays at a low angle meet its own faces. As in Cycles, they
// begin on the curved surface that the normals describe (geometry offset), and light fades out before the angle at
// which they would end (shading offset; the workaround of the renderer appleseed).

layout(local_size_x = 64) in;

#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
#include "common/geometry.glsl"
#include <ShadingInstance>
readonly buffer Closures;
buffer ShadowRays;
buffer Contributions;
readonly buffer Triangles;
readonly buffer Attributes;
readonly buffer ShadingInstances;

// Of corners with normals: how far a point may rise along the surface's normal until it lies above the planes through
// the corners; sign: -1 for one that faces away from the normals, and goes down.
float envelope_height(vec3 corners[3], vec3 normals[3], vec3 point, float sign) {
    float least = INFINITY_DISTANCE;
    for (int k = 0; k < 3; ++k) {
        vec3 to_next = corners[(k + 1) % 3] - corners[k], to_last = corners[(k + 2) % 3] - corners[k];
        float rise = max(max(sign * dot(to_next, normals[k]), sign * dot(to_last, normals[k])), 0.0);
        least = min(least, max(sign * dot(corners[k] - point, normals[k]) + rise, 0.0));
    }
    return least;
}

// From a point of a triangle to the curved surface; geometric: the normal of the side that the light is on.
vec3 to_curved_surface(uint triangle, vec3 point, vec3 geometric) {
    vec3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = triangle_vertices[3u * triangle + uint(k)].xyz;
    vec3 normals[3] =
        vec3[3](unpack_unit_vector(attributes[triangle].normal0), unpack_unit_vector(attributes[triangle].normal1),
                unpack_unit_vector(attributes[triangle].normal2));
    vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], face = cross(e1, e2), offset = point - corners[0];
    float size2 = max(dot(face, face), 1e-30);
    float b1 = dot(cross(offset, e2), face) / size2, b2 = dot(cross(e1, offset), face) / size2, b0 = 1.0 - b1 - b2;
    vec3 normal = b0 * normals[0] + b1 * normals[1] + b2 * normals[2];
    // A parabola over the triangle that has its normals at the corners.
    float bend02 = dot(normals[2] - normals[0], corners[0] - corners[2]),
          bend12 = dot(normals[2] - normals[1], corners[1] - corners[2]),
          bend01 = dot(normals[1] - normals[0], corners[1] - corners[0]);
    float height = 0.5 * (bend02 * b0 * (b0 - 1.0) + (bend02 + bend12 + bend01) * b0 * b1 + bend12 * b1 * (b1 - 1.0));
    bool outside = dot(normal, geometric) > 0.0;
    float envelope = envelope_height(corners, normals, point, outside ? 1.0 : -1.0);
    return normal * (outside ? max(envelope, height) : min(-envelope, height));
}

// By how much of the geometry offset a ray is moved: all of it where light and surface are nearly parallel.
float moved_fraction(float cutoff, float shading_cosine, float geometric_cosine) {
    float past = shading_cosine < cutoff ? geometric_cosine + shading_cosine - cutoff : geometric_cosine;
    return clamp(1.0 - past / cutoff, 0.0, 1.0);
}

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray ray = shadow_rays[index];
    uint triangle = ray.source_triangle;
    vec3 light = ray.direction;
    float fading = terminator_factor(closures[index].flags, unpack_unit_vector(closures[index].diffuse_normal), light);
    if (fading != 1.0) contributions[index].rgb *= fading;
    float offset = shading_instances[attributes[triangle].instance].terminator_offset;
    if (!(offset > 0.0)) return;
    float cosine = dot(unpack_unit_vector(closures[index].shading_normal), light);
    vec3 geometric = unpack_unit_vector(closures[index].geometric_normal);
    if (cosine < 0.0) geometric = -geometric;
    float geometric_cosine = dot(geometric, light), moved = moved_fraction(offset, abs(cosine), geometric_cosine);
    if (moved <= 0.0) return;
    // Where the face looks away from the light, it is to be met.
    if (geometric_cosine <= 0.0) shadow_rays[index].source_triangle = NO_TRIANGLE;
    vec3 way = moved * to_curved_surface(triangle, closures[index].position, geometric);
    if (way == vec3(0.0)) return;
    shadow_rays[index].origin = ray.origin + way;
    if (ray.maximum_distance >= INFINITY_DISTANCE) return;
    vec3 to_light = ray.maximum_distance * light - way;
    float distance = length(to_light);
    shadow_rays[index].direction = to_light / distance;
    shadow_rays[index].maximum_distance = distance;
}
