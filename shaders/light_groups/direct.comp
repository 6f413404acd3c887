#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What shadow rays bring, by the groups of the lights that they went to.

layout(local_size_x = 64) in;

#include <LightGroupParameters>
#include "common/living_paths.glsl"
layout(std140, binding = 0) uniform Parameters { LightGroupParameters parameters; };
#include "light_groups/grouped.glsl"
layout(std430, binding = 0) readonly buffer Visibility;
layout(std430, binding = 1) readonly buffer Contributions;
layout(std430, binding = 2) readonly buffer LightSplits;
layout(std430, binding = 3) readonly buffer LightTriangles;
layout(std430, binding = 6) readonly buffer LightGroupTable;
layout(std430, binding = 7) readonly buffer Attributes;
#include "light_groups/table.glsl"

void main() {
    uint index = living_path();
    if (index == NO_PATH || visibility[index] == 0u) return;
    vec4 contribution = contributions[index];
    uint group = light_group(light_splits[index].light, light_triangles[index]);
    add_to_group(index, group, contribution.w > 0.0, contribution.rgb);
}
