#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Photons into the ranges of their buckets, which then end behind the last of them.

layout(local_size_x = 64) in;

#include <GridParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
uniform Parameters { GridParameters parameters; };
#include "density_estimation/photon_grid/grids.glsl"
readonly buffer Photons;
readonly buffer StoredPhotons;
buffer Buckets;
writeonly buffer SortedPhotons;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint number = stored_photons[index];
    vec3 position = photons[number].position;
    uvec2 grids = grids_of(photons[number].flags);
    for (uint grid = grids.x; grid <= grids.y; ++grid)
        sorted_photons[atomicAdd(buckets[bucket_in(grid, cell_of(position, side_of(grid)))].y, 1u)] =
            uvec4(floatBitsToUint(position), number);
}
