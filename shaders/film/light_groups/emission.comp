#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the emission of the world or of a surface at the end of a ray to its group (light objects: light_objects.comp).

layout(local_size_x = 64) in;

#include <LightGroupParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
uniform Parameters { LightGroupParameters parameters; };
#include "film/light_groups/grouped.glsl"
readonly buffer Closures;
readonly buffer Radiances;
readonly buffer RadianceBefore;
readonly buffer LightGroupTable;
readonly buffer Attributes;
#include "film/light_groups/table.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    uint triangle = closures[index].triangle;
    uint group = triangle == NO_TRIANGLE ? iteration.world_group : light_group(0u, triangle);
    add_to_group(index, group, false, radiances[index].rgb - radiance_before[index].rgb);
}
