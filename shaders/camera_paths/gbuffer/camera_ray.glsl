// SPDX-License-Identifier: GPL-3.0-or-later
// Rays of cameras with a plane before them, in the camera's axes: (right, up, forward).
// The includer declares the storage block of the camera.
#include <Ray>
#include <CameraView>
#include "common/constants.glsl"
#include "camera_paths/gbuffer/sheared.glsl"

// `start_distance` is the distance from the camera to the origin, at the clip start; `area` is the area of a pixel at
// distance 1 across the ray, m^2, or at any distance where rays are parallel. `reach` 0: the pixel shows nothing.
struct CameraRay {
    vec3 origin;
    vec3 direction;
    float start_distance;
    float reach;
    float area;
};

// Where the middle of a pixel lies on the window.
vec2 window_point(uint index) {
    vec2 pixel = vec2(index % camera.width, index / camera.width);
    return mix(camera.window.xz, camera.window.yw, (pixel + 0.5) / vec2(camera.width, camera.height));
}

// All rays through a window point meet at the distance of focus, wherever on the lens they start. As in Cycles, clip
// distances are those of the ray through the lens's center in perspective.
CameraRay plane_ray(vec2 at, vec2 lens) {
    bool orthographic = camera.projection == PROJECTION_ORTHOGRAPHIC;
    vec3 axis = orthographic ? vec3(0.0, 0.0, 1.0) : vec3(at, 1.0);
    bool pinhole = lens == vec2(0.0);
    CameraRay ray;
    ray.direction = pinhole ? normalize(axis) : normalize(camera.focus_distance * axis - vec3(lens, 0.0));
    float stretch = orthographic ? 1.0 / ray.direction.z : length(axis);
    ray.start_distance = camera.clip_start * stretch;
    ray.reach = (camera.clip_end - camera.clip_start) * (orthographic ? 1.0 : stretch);
    ray.origin = vec3(lens + (orthographic ? at : vec2(0.0)), 0.0) + ray.start_distance * ray.direction;
    float cosine = ray.direction.z;
    ray.area = camera.pixel_area * (orthographic ? cosine : cosine * cosine * cosine);
    return ray;
}

// Distances are those in the world, as in Cycles.
Ray sheared_ray(CameraRay ray) {
    mat3 axes = mat3(camera.right, camera.up, camera.forward);
    vec3 direction = normalize(axes * ray.direction);
    vec3 start = axes * (ray.origin - ray.start_distance * ray.direction);
    return Ray(camera.position + start + ray.start_distance * direction, NO_TRIANGLE, direction, ray.reach);
}

Ray world_ray(CameraRay ray) {
    mat3 axes = mat3(camera.right, camera.up, camera.forward);
    return Ray(camera.position + axes * ray.origin, NO_TRIANGLE, axes * ray.direction, ray.reach);
}
