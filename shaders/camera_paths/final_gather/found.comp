#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What each gathering ray found: by shadow rays, of photons, and of the world.

layout(local_size_x = 64) in;

#include <FoundParameters>
#include "common/invocation.glsl"
#include "common/gathering.glsl"
uniform Parameters { FoundParameters parameters; };
#include "density_estimation/splat_sums/read.glsl"
buffer GatherRadiances;
readonly buffer GatheringVertices;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    if (gathering_vertices[index].shared_radius < 0.0) return;
    gather_radiances[index].rgb += read_sum(index, true) * parameters.quantum + gathering_vertices[index].found;
}
