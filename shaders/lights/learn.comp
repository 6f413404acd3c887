#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Counts, for each cell of the guide, the photons that left through it and those that came to an importon: a thread
// for each vertex of their paths, and one for each path.

layout(local_size_x = 64) in;

#include <LearnParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
uniform Parameters { LearnParameters parameters; };
readonly buffer Photons;
buffer PhotonCells;
buffer Tallies { uvec2 tallies[]; };  // left, contributed

readonly buffer PhotonRange;

#include <GuideCells>

void main() {
    uint index = invocation_index();
    if (index < parameters.count) {
        uint cell = photon_cells[index];
        if (cell != NO_CELL) atomicAdd(tallies[cell & ~CELL_CONTRIBUTED].x, 1u);
    }
    if (index >= photon_end || (photons[index].depth & PHOTON_CONTRIBUTED) == 0u) return;
    uint path = photon_path_of(photons[index].path);
    if (photon_cells[path] == NO_CELL) return;
    uint cell = atomicOr(photon_cells[path], CELL_CONTRIBUTED);
    if ((cell & CELL_CONTRIBUTED) == 0u) atomicAdd(tallies[cell].y, 1u);
}
