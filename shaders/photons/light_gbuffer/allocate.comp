#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Room for the triangles of each texel: `end` is where they begin until they are put there.
layout(local_size_x = 64) in;

#include <LightGBufferParameters>
#include "common/invocation.glsl"
uniform Parameters { LightGBufferParameters parameters; };
#define TEXELS_ACCESS
#include "photons/light_gbuffer/views.glsl"
#include "photons/light_gbuffer/jobs.glsl"

void main() {
    uint index = invocation_index();
    if (index >= parameters.view_count * parameters.side * parameters.side) return;
    uint count = light_texels[index].count;
    if (count > 0u && count <= MOST_TRIANGLES) light_texels[index].end = atomicAdd(light_counts.triangles, count);
}
