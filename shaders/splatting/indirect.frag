#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A photon meets the importons listed in one pixel of the cubemap (paper section 4.2).

#include <QuadParameters>
#include "common/importon.glsl"
#include "splatting/gathered.glsl"
layout(std140, binding = 0) uniform Parameters { QuadParameters parameters; };
layout(std430, binding = 0) readonly buffer Photons { Photon photons[]; };
layout(std430, binding = 1) readonly buffer Importons { Importon importons[]; };
layout(std430, binding = 2) readonly buffer Heads { uint heads[]; };

flat in uint photon_number;
flat in uint face;

void main() {
    // The atlas is three faces wide: width / 3 cells to a face.
    ivec2 size = ivec2(int(parameters.width) / 3);
    ivec2 cell = ivec2(gl_FragCoord.xy) - ivec2(int(face) % 3, int(face) / 3) * size;
    uint entry = heads[(int(face) * size.x + cell.y) * size.x + cell.x];
    if (entry == 0u) return;
    Photon photon = photons[photon_number];
    while (entry != 0u) {
        Importon importon = importons[entry - 1u];
        vec3 radiance;
        if (density_estimate(importon, photon, parameters.wide_radius, radiance)) add_gathered(entry - 1u, radiance);
        entry = importon.next;
    }
}
