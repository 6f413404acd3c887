#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The light of a group that arrives along the rays of the final gather, which neighboring pixels reuse.

layout(local_size_x = 64) in;

#include <LightGroupParameters>
#include <FinalGather>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/gathering.glsl"
uniform Parameters { LightGroupParameters parameters; };
#include "film/light_groups/grouped.glsl"
#include "film/light_groups/read_group_sum.glsl"
readonly buffer FinalGatherOrigins;
readonly buffer FinalGatherHits;
writeonly buffer GatherRadiances;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count || final_gather_origins[index].reuse_radius == NO_FINAL_GATHER) return;
    vec3 light = grouped_light_of(index, parameters.group, true)
                 + read_group_sum(index, parameters.group, true) * parameters.quantum;
    if (parameters.group == iteration.world_group) light += final_gather_hits[index].radiance;
    gather_radiances[index] = vec4(light, 0.0);
}
