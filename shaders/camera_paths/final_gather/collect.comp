#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The radiance that arrives along each ray of the final gather: of shadow rays, of photons, and of the environment.

layout(local_size_x = 64) in;

#include <CollectParameters>
#include <FinalGather>
#include "common/invocation.glsl"
#include "common/gathering.glsl"
uniform Parameters { CollectParameters parameters; };
#include "density_estimation/splat_sums/read.glsl"
buffer GatherRadiances;
readonly buffer FinalGatherOrigins;
readonly buffer FinalGatherHits;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    if (final_gather_origins[index].reuse_radius == NO_FINAL_GATHER) return;
    gather_radiances[index].rgb += read_sum(index, true) * parameters.quantum + final_gather_hits[index].radiance;
}
