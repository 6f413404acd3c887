#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What the camera sees first: normals averaged over the iterations that came to a surface or passed all by, depth of
// the first that found one. As in Cycles, surfaces that let more than half of the light straight through are passed, and depth lies along the view
// axis, or in a panorama along the ray.

layout(local_size_x = 64) in;

#include <CameraView>
#include <Closure>
#include <Ray>
#include <SurfaceParameters>
#include "common/living_paths.glsl"
#include "common/geometry.glsl"
#include "common/camera_path.glsl"
#include "gbuffer/projections.glsl"
layout(std140, binding = 0) uniform Parameters { SurfaceParameters parameters; };
layout(std430, binding = 0) readonly buffer Camera { CameraView camera; };
layout(std430, binding = 1) readonly buffer Closures { Closure closures[]; };
layout(std430, binding = 2) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 3) buffer CameraPaths { CameraPath camera_paths[]; };
layout(std430, binding = 4) buffer Surfaces { vec4 surfaces[]; };
layout(std430, binding = 5) buffer SurfaceCounts { uint surface_counts[]; };

const float BACKGROUND_DEPTH = 1e10;  // as Cycles writes it
const float MOSTLY_TRANSPARENT = 0.5;

void main() {
    uint index = living_path();
    if (index == NO_PATH) return;
    uint pixel = parameters.first_pixel + index;
    if (parameters.segment == 0u && parameters.iteration == 1u) {
        surfaces[pixel] = vec4(vec3(0.0), BACKGROUND_DEPTH);
        surface_counts[pixel] = 0u;
    }
    uint flags = camera_paths[index].flags;
    if (!(rays[index].maximum_distance > 0.0) || (flags & PATH_STRAIGHT) == 0u || (flags & PATH_SURFACE_FOUND) != 0u) return;
    bool hit = closures[index].triangle != NO_TRIANGLE;
    vec3 transparent = closures[index].transparent;
    if (hit && (transparent.r + transparent.g + transparent.b) / 3.0 > MOSTLY_TRANSPARENT) return;
    camera_paths[index].flags = flags | PATH_SURFACE_FOUND;
    vec3 normal = hit ? unpack_unit_vector(closures[index].shading_normal) : vec3(0.0);
    vec4 surface = surfaces[pixel];
    // A path may have ended on its way through: the next that finds a surface tells the depth.
    vec3 offset = closures[index].position - camera.position;
    if (hit && surface.w == BACKGROUND_DEPTH)
        surface.w = camera.projection <= PROJECTION_ORTHOGRAPHIC ? dot(offset, camera.forward) : length(offset);
    uint count = ++surface_counts[pixel];
    surface.xyz += (normal - surface.xyz) / float(count);
    surfaces[pixel] = surface;
}
