#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Where a pixel took more caustic photons than its disk should hold, the disk becomes smaller, down to Eq. 3's.

layout(local_size_x = 64) in;

#include <NarrowParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "density_estimation/splat_sums/sums.glsl"
uniform Parameters { NarrowParameters parameters; };
readonly buffer PhotonCounts;
buffer RadiusFactors;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    float factor = iteration.number == 1u ? parameters.max_factor : radius_factors[index];
    float taken = float(photon_counts[caustic_place(index)]);
    if (taken > parameters.expected) factor = max(factor * sqrt(parameters.expected / taken), 1.0);
    radius_factors[index] = factor;
}
