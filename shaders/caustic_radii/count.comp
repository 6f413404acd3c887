#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps of each pixel of a band how many caustic photons it took, until it is known how many photons come next.

layout(local_size_x = 64) in;

#include <CountCausticsParameters>
#include "common/invocation.glsl"
#include "splat_sums/sums.glsl"
layout(std140, binding = 0) uniform Parameters { CountCausticsParameters parameters; };
layout(std430, binding = 0) readonly buffer PhotonCounts;
layout(std430, binding = 1) writeonly buffer CausticsTaken;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    caustics_taken[index] = float(photon_counts[caustic_place(index)]) * parameters.photons_for_one;
}
