#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: TEXEL_BUFFERS=1
// The media that camera paths begin in: those at the camera, and what lies on the way from there to where each ray
// begins. Texels have no camera.

layout(local_size_x = 64) in;

#include <EnterMediaParameters>
#include "common/living_paths.glsl"
#include "common/camera_path.glsl"
layout(std140, binding = 0) uniform Parameters { EnterMediaParameters parameters; };
layout(std430, binding = 0) readonly buffer MediaOfSources;
layout(std430, binding = 1) readonly buffer Attributes;
layout(std430, binding = 2) readonly buffer MediumBoxes;
layout(std430, binding = 3) readonly buffer Rays;
layout(std430, binding = 5) buffer CameraPaths;
layout(std430, binding = 7) readonly buffer Materials;
#include "media/crossings.glsl"

void main() {
    uint index = living_path();
    if (index == NO_PATH || !(rays[index].maximum_distance > 0.0)) return;
    vec3 origin = rays[index].origin;
    uint media = parameters.has_camera != 0u
        ? media_beyond(parameters.camera_position, media_of_sources[parameters.light_count], origin) : media_at(origin);
    camera_paths[index].flags |= media << FIRST_MEDIUM;
}
