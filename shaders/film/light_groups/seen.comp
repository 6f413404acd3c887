#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What camera paths met in a segment, but for light objects (passed.comp): the world, or a surface that shines.

layout(local_size_x = 64) in;

#include <LightGroupParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
uniform Parameters { LightGroupParameters parameters; };
#include "film/light_groups/grouped.glsl"
readonly buffer Closures;
readonly buffer Radiances;
readonly buffer SeenLight;
readonly buffer LightGroupTable;
readonly buffer Attributes;
#include "film/light_groups/table.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    uint triangle = closures[index].triangle;
    uint group = triangle == NO_TRIANGLE ? iteration.world_group : light_group(0u, triangle);
    add_to_group(index, group, false, radiances[index].rgb - seen_light[index].rgb);
}
