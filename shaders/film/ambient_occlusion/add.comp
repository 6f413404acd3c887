#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What the rays of the pass Ambient Occlusion bring.

layout(local_size_x = 64) in;

#include <AmbientOcclusionParameters>
#include "common/active_paths.glsl"
uniform Parameters { AmbientOcclusionParameters parameters; };
#include "film/passes.glsl"
readonly buffer Visibility;
readonly buffer Contributions;

void main() {
    uint index = active_path();
    if (index == NO_PATH || visibility[index] == 0u) return;
    add_to_pass(PASS_AMBIENT_OCCLUSION, index, contributions[index].rgb);
}
