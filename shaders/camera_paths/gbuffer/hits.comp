#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The visibility buffer becomes rays, hits and fresh camera paths.

layout(local_size_x = 64) in;

#include "common/invocation.glsl"
#include "common/camera_path.glsl"
uniform sampler2D visibility;
readonly buffer Camera;
readonly buffer Triangles;
writeonly buffer Rays;
writeonly buffer Hits;
writeonly buffer CameraPaths;
#include "camera_paths/gbuffer/camera_ray.glsl"
#include "common/intersection.glsl"

// By the test of rays that are traced, so that both ways give the same bits. Rasterization may round a pixel onto a
// triangle that its ray just misses: there the hit is the nearest point of the triangle.
Hit seen_hit(Ray ray, uint triangle) {
    vec3 v0 = triangle_vertices[3u * triangle].xyz, v1 = triangle_vertices[3u * triangle + 1u].xyz,
         v2 = triangle_vertices[3u * triangle + 2u].xyz;
    Hit hit = Hit(NO_TRIANGLE, 0.0, 0.0, INFINITY_DISTANCE);
    intersect_triangle(make_watertight_ray(ray.origin, ray.direction), triangle, v0, v1, v2, hit);
    if (hit.triangle != NO_TRIANGLE) return hit;
    vec3 e1 = v1 - v0, e2 = v2 - v0;
    vec3 p = cross(ray.direction, e2);
    float determinant = dot(e1, p);
    vec3 s = ray.origin - v0;
    vec2 b = vec2(1.0 / 3.0);
    if (determinant != 0.0) b = vec2(dot(s, p), dot(ray.direction, cross(s, e1))) / determinant;
    b = clamp(b, 0.0, 1.0);
    b /= max(1.0, b.x + b.y);
    return Hit(triangle, b.x, b.y, length(b.x * e1 + b.y * e2 - s));
}

void main() {
    uint index = invocation_index();
    if (index >= camera.width * camera.height) return;
    CameraRay camera_ray = plane_ray(window_point(index), vec2(0.0));
    Ray ray = world_ray(camera_ray);
    vec2 visible = texelFetch(visibility, ivec2(index % camera.width, index / camera.width), 0).xy;
    uint number = uint(visible.x + 0.5) | (uint(visible.y + 0.5) << 16u);
    rays[index] = ray;
    hits[index] = number == 0u ? Hit(NO_TRIANGLE, 0.0, 0.0, INFINITY_DISTANCE) : seen_hit(ray, number - 1u);
    camera_paths[index] = CameraPath(vec3(1.0), 0.0, camera_ray.start_distance, 0.0, sqrt(camera_ray.area / PI),
                                     PATH_CAMERA_TRANSPARENT, 0u, 0u, 0u, 0.0, 0u, 0u, NO_PDF, 1.0);
}
