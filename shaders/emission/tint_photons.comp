#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Emitters whose emission varies were sampled as if of radiance 1. Photons that left such emitters carry the radiance of their place and direction.

layout(local_size_x = 64) in;

#include <Closure>
#include <CountParameters>
#include <PhotonPath>
#include "common/constants.glsl"
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { CountParameters parameters; };
layout(std430, binding = 0) readonly buffer Closures { Closure closures[]; };
layout(std430, binding = 1) buffer PhotonPaths { PhotonPath photon_paths[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count || closures[index].triangle == NO_TRIANGLE) return;
    photon_paths[index].flux *= closures[index].emission;
}
