#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: MEDIA=1
// A photon meets the importons listed in one pixel of the cubemap (paper section 4.2).

#include <QuadParameters>
#include "common/photon.glsl"
uniform Parameters { QuadParameters parameters; };
buffer Photons;
readonly buffer Importons;
readonly buffer Heads;
#include "common/importon.glsl"
#include "density_estimation/splatting/meet.glsl"

flat in uint photon_number;
flat in uint face;

void main() {
    // The atlas is three faces wide: width / 3 cells to a face.
    ivec2 size = ivec2(int(parameters.width) / 3);
    ivec2 cell = ivec2(gl_FragCoord.xy) - ivec2(int(face) % 3, int(face) / 3) * size;
    int place = (int(face) * size.x + cell.y) * size.x + cell.x;
    for (uint entry = heads[place]; entry != 0u; entry = importons[entry - 1u].next) meet(entry - 1u, photon_number);
}
