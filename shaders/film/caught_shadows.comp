#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility of light at the shadow catchers of a pixel: X weighted by visibility, Y without
// (session/render/frame_passes.py divides one by the other).

layout(local_size_x = 64) in;

#include <PassParameters>
#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
#include "common/camera_path.glsl"
uniform Parameters { PassParameters parameters; };
#include "film/passes.glsl"
readonly buffer Closures;
readonly buffer Rays;
readonly buffer CameraPaths;
readonly buffer CatcherVisibility;

void main() {
    uint index = active_path();
    if (index == NO_PATH || !(rays[index].maximum_distance > 0.0)) return;
    bool catches = closure_hit(closures[index]) && (closures[index].flags & CLOSURE_CATCHES_SHADOWS) != 0u;
    if (!catches || (camera_paths[index].flags & PATH_CAMERA_TRANSPARENT) == 0u) return;
    vec3 throughput = camera_paths[index].throughput;
    float mean_throughput = (throughput.r + throughput.g + throughput.b) / 3.0;
    add_to_pass(PASS_SHADOW_CATCHER, index,
                vec3(mean_throughput * float(catcher_visibility[index]), mean_throughput, 0.0));
}
