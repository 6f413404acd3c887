#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What reached its light is added to the radiance of the pixels, or to that of their gathering rays.

layout(local_size_x = 64) in;

#include "common/active_paths.glsl"
readonly buffer Visibility;
readonly buffer Contributions;
buffer Radiances;
buffer GatherRadiances;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    vec4 contribution = contributions[index];
    if (visibility[index] == 0u) return;
    if (contribution.w > 0.0) gather_radiances[index].rgb += contribution.rgb;
    else radiances[index].rgb += contribution.rgb;
}
