#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What shadow rays bring, by the groups of the lights that they went to.

layout(local_size_x = 64) in;

#include <LightGroupParameters>
#include "common/active_paths.glsl"
uniform Parameters { LightGroupParameters parameters; };
#include "film/light_groups/grouped.glsl"
readonly buffer Visibility;
readonly buffer Contributions;
readonly buffer LightSplits;
readonly buffer LightTriangles;
readonly buffer LightGroupTable;
readonly buffer Attributes;
#include "film/light_groups/table.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH || visibility[index] == 0u) return;
    vec4 contribution = contributions[index];
    uint group = light_group(light_splits[index].light, light_triangles[index]);
    add_to_group(index, group, contribution.w > 0.0, contribution.rgb);
}
