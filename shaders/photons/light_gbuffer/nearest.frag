#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Where the first triangle of each texel ends: the greater complement is the nearer depth, and 0 is none.
#include "photons/light_gbuffer/fragment.glsl"

void main() {
    TexelFragment fragment = texel_fragment();
    if (!fragment.is_covered) return;
    uint complement = ~floatBitsToUint(fragment.depths.y);
    if (light_texels[fragment.texel].depth_complement < complement)
        atomicMax(light_texels[fragment.texel].depth_complement, complement);
}
