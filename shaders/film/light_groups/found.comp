#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// What gathering rays found of the light of a group, to be shared among neighbors.

layout(local_size_x = 64) in;

#include <LightGroupParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/gathering.glsl"
uniform Parameters { LightGroupParameters parameters; };
#include "film/light_groups/grouped.glsl"
#include "film/light_groups/read_group_sum.glsl"
readonly buffer GatheringVertices;
writeonly buffer GatherRadiances;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count || gathering_vertices[index].shared_radius < 0.0) return;
    vec3 found = grouped_light_of(index, parameters.group, true)
                 + read_group_sum(index, parameters.group, true) * parameters.quantum;
    if (parameters.group == iteration.world_group) found += gathering_vertices[index].found;
    gather_radiances[index] = vec4(found, 0.0);
}
