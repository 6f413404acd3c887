#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the radiance along the rays of the final gather: direct light of the world, and caustics.

layout(local_size_x = 64) in;

#include <LightPassParameters>
#include <FinalGather>
#include "common/invocation.glsl"
#include "common/bsdf/microfacet.glsl"
#include "common/gathering.glsl"
#include "common/path_history.glsl"
uniform Parameters { LightPassParameters parameters; };
readonly buffer FinalGatherOrigins;
readonly buffer FinalGatherHits;
readonly buffer Importons;
readonly buffer LightSums;
#include "film/light_passes/read_light_sum.glsl"
writeonly buffer GatheredDirect { vec4 gathered_direct[]; };
buffer GatheredCaustics;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count || final_gather_origins[index].reuse_radius == NO_FINAL_GATHER) return;
    vec3 world = final_gather_hits[index].radiance;
    uint history = departing_history(importons[index].history);
    if (parameters.scattered != 0u)
        gathered_direct[index] = vec4((history & HISTORY_AGAIN) == 0u ? world : vec3(0.0), 0.0);
    if (parameters.caustics == 0u) return;
    vec3 caustic = read_light_sum(index, FINAL_GATHER_CAUSTICS, parameters.light_sums) * parameters.quantum;
    if ((history & HISTORY_CAUSTIC) != 0u) caustic += world;
    gathered_caustics[index].rgb += caustic;
}
