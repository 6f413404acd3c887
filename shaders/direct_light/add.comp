#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: CLAMPS_LIGHT=1
// What reached its light is added to the radiance of the pixels, or to that of their gathering rays.

layout(local_size_x = 64) in;

#include "common/active_paths.glsl"
readonly buffer Visibility;
#include "common/camera_path.glsl"
#include "common/clamping.glsl"
#include "common/path_depth.glsl"
buffer Contributions;
readonly buffer CameraPaths;
buffer Radiances;
buffer GatherRadiances;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    vec4 contribution = contributions[index];
    if (visibility[index] == 0u) return;
#ifdef CLAMPS_LIGHT
    // The passes take it from there.
    if (!(contribution.w > 0.0)) {
        contribution.rgb = clamped_light(contribution.rgb, bounces_of(camera_paths[index].depth));
        contributions[index] = contribution;
    }
#endif
    if (contribution.w > 0.0) gather_radiances[index].rgb += contribution.rgb;
    else radiances[index].rgb += contribution.rgb;
}
