#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Which triangles these are, where a photon may test them all.
#include "photons/light_gbuffer/fragment.glsl"
writeonly buffer TexelTriangles;

void main() {
    TexelFragment found = texel_fragment();
    if (!before_horizon(found) || light_texels[found.texel].count > MOST_TRIANGLES) return;
    texel_triangles[atomicAdd(light_texels[found.texel].end, 1u)] = found.triangle;
}
