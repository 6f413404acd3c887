#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Which triangles these are, where a photon may test them all.
#include "photons/light_gbuffer/fragment.glsl"
writeonly buffer TexelTriangles;

void main() {
    TexelFragment fragment = texel_fragment();
    if (!before_horizon(fragment) || light_texels[fragment.texel].count > MOST_TRIANGLES) return;
    texel_triangles[atomicAdd(light_texels[fragment.texel].end, 1u)] = fragment.triangle;
}
