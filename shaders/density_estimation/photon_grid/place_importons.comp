#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The list of importons that gather, those of a cell side by side: the threads of a group then walk the same photons.

layout(local_size_x = 64) in;

#include <GroupParameters>
#include "common/active_paths.glsl"
#include "density_estimation/photon_grid/cells.glsl"
uniform Parameters { GroupParameters parameters; };
readonly buffer Importons;
buffer Buckets;
writeonly buffer Visits;

void main() {
    uint index = active_path();
    if (invocation_index() == 0u) {
        visit_count = cursor;
        visit_groups = uint[3]((cursor + parameters.group_size - 1u) / parameters.group_size, 1u, 1u);
    }
    if (index == NO_PATH || !(importons[index].radius > 0.0)) return;
    visits[atomicAdd(buckets[bucket_of(cell_of(importons[index].position, parameters.side), parameters.buckets)].y,
                     1u)] = uvec2(index, 0u);
}
