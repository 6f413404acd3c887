#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// How many importons each bucket of cells holds.

layout(local_size_x = 64) in;

#include <GroupParameters>
#include "common/active_paths.glsl"
#include "density_estimation/photon_grid/cells.glsl"
uniform Parameters { GroupParameters parameters; };
readonly buffer Importons;
buffer Buckets;

void main() {
    uint index = active_path();
    if (index == NO_PATH || !(importons[index].radius > 0.0)) return;
    atomicAdd(buckets[bucket_of(cell_of(importons[index].position, parameters.side), parameters.buckets)].y, 1u);
}
