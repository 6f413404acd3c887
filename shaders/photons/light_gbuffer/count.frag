#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// How many triangles of each texel begin before its horizon.
#include "photons/light_gbuffer/fragment.glsl"

void main() {
    TexelFragment fragment = texel_fragment();
    if (before_horizon(fragment)) atomicAdd(light_texels[fragment.texel].count, 1u);
}
