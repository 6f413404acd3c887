#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Counts, for each cell of the guide, the photons that left through it and those that came to an importon.

layout(local_size_x = 64) in;

#include <LearnParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
layout(std140, binding = 0) uniform Parameters { LearnParameters parameters; };
layout(std430, binding = 0) readonly buffer Photons;
layout(std430, binding = 1) readonly buffer PhotonCells;
layout(std430, binding = 2) buffer Tallies { uvec2 tallies[]; };  // left, contributed

#include <GuideCells>

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint cell = photon_cells[index];
    if (cell == NO_CELL) return;
    bool contributed = false;
    for (uint segment = 0u; segment < parameters.segments && !contributed; ++segment) {
        uint slot = segment * parameters.count + index;
        if ((photons[slot].flags & PHOTON_ACTIVE) == 0u) break;
        contributed = photons[slot].contributed != 0u;
    }
    atomicAdd(tallies[cell].x, 1u);
    if (contributed) atomicAdd(tallies[cell].y, 1u);
}
