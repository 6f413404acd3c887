#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Emitters whose emission varies were sampled as if of radiance 1. Photons that left such emitters carry the radiance
// of their place and direction.

layout(local_size_x = 64) in;

#include "common/constants.glsl"
#include "common/active_paths.glsl"
readonly buffer Closures;
buffer PhotonPaths;

void main() {
    uint index = active_path();
    if (index == NO_PATH || closures[index].triangle == NO_TRIANGLE) return;
    photon_paths[index].flux *= closures[index].emission;
}
