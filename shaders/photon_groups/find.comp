#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The light groups of photons that leave the lights.

layout(local_size_x = 64) in;

#include <PhotonGroupParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { PhotonGroupParameters parameters; };
#include "lights/light_table.glsl"
layout(std430, binding = 0) readonly buffer Rays;
layout(std430, binding = 1) writeonly buffer PhotonGroups;
layout(std430, binding = 6) readonly buffer LightGroupTable;
layout(std430, binding = 7) readonly buffer Attributes;
#include "light_groups/table.glsl"

void main() {
    uint index = invocation_index();
    if (index < parameters.count) photon_groups[index] = light_group(light_of(index), rays[index].source_triangle);
}
