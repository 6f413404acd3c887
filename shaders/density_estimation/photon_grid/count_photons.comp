#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// How many photons each bucket holds.

layout(local_size_x = 64) in;

#include <GridParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
uniform Parameters { GridParameters parameters; };
#include "density_estimation/photon_grid/grids.glsl"
readonly buffer Photons;
readonly buffer StoredPhotons;
buffer Buckets;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint number = stored_photons[index];
    uvec2 grids = grids_of(photons[number].flags);
    for (uint grid = grids.x; grid <= grids.y; ++grid)
        atomicAdd(buckets[bucket_in(grid, cell_of(photons[number].position, side_of(grid)))].y, 1u);
    // Threads that meet here write the same.
    if (grids.x >= CAUSTIC_GRIDS) wide_in_use[grids.x - CAUSTIC_GRIDS] = 1u;
}
