#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// A ray from each surface that the camera sees, cosine-weighted around the normal of its diffuse part, or its own.

layout(local_size_x = 64) in;

#include <AmbientOcclusionParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/low_discrepancy.glsl"
#include "common/sampling.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
uniform Parameters { AmbientOcclusionParameters parameters; };
readonly buffer Closures;
readonly buffer Rays;
readonly buffer CameraPaths;
writeonly buffer ShadowRays;
writeonly buffer LightTriangles;
writeonly buffer Contributions;
#ifdef MEDIA
readonly buffer Media;
#include "materials/medium.glsl"
writeonly buffer ShadowMedia;
#endif

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    shadow_rays[index] = Ray(vec3(0.0), NO_TRIANGLE, vec3(0.0, 0.0, 1.0), 0.0);
    light_triangles[index] = NO_TRIANGLE;
    contributions[index] = vec4(0.0);
    Closure closure = closures[index];
    CameraPath path = camera_paths[index];
    bool is_seen =
        rays[index].maximum_distance > 0.0 && closure_hit(closure) && (path.flags & PATH_CAMERA_TRANSPARENT) != 0u;
    vec3 weight = path.throughput * (1.0 - closure.transparent);
    if (!is_seen || !(largest(weight) > 0.0) || !(parameters.reach > 0.0)) return;
    uvec4 choices = pcg4d(
        uvec4(parameters.first_pixel + index, parameters.segment, iteration.seed, STAGE_AMBIENT_OCCLUSION << 24u));
    vec3 normal = unpack_unit_vector(largest(closure.diffuse) > 0.0 ? closure.diffuse_normal : closure.shading_normal);
    vec3 direction = sample_cosine_hemisphere(normal, scrambled_sobol(iteration.number - 1u, choices));
    vec3 geometric = unpack_unit_vector(closure.geometric_normal);
    float offset = dot(direction, geometric) > 0.0 ? closure.ray_offset : -closure.ray_offset;
    shadow_rays[index] = Ray(closure.position + offset * geometric, closure.triangle, direction, parameters.reach);
    contributions[index] = vec4(weight, 0.0);
#ifdef MEDIA
    shadow_media[index] = path.flags & ~PATH_MASK;
#endif
}
