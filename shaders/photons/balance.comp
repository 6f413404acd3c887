#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of the fluxes that photon paths emit, absorb, deposit, lose and let escape: over the channels and the paths of a
// group.

layout(local_size_x = 64) in;

#include <PhotonPath>
#include <FluxSums>
#include <BalanceParameters>
#include <Dispatch>
#include "common/invocation.glsl"
uniform Parameters { BalanceParameters parameters; };
readonly buffer Emitted;
readonly buffer PhotonPaths;
writeonly buffer Sums { FluxSums sums[]; };

shared FluxSums partial_sums[GROUP_SIZE];

float channel_sum(vec3 flux) { return flux.x + flux.y + flux.z; }

FluxSums path_fluxes(uint index) {
    FluxSums result = FluxSums(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    if (index >= parameters.photon_count) return result;
    PhotonPath path = photon_paths[index];
    result.emitted = channel_sum(emitted[index].flux);
    result.escaped = path.escaped;
    result.deposited = path.deposited;
    result.lost = channel_sum(path.flux);
    result.absorbed = result.emitted - result.escaped - result.deposited - result.lost;
    return result;
}

void main() {
    uint own = gl_LocalInvocationIndex;
    partial_sums[own] = path_fluxes(invocation_index());
    for (uint half_size = GROUP_SIZE / 2u; half_size > 0u; half_size >>= 1u) {
        barrier();
        if (own < half_size) {
            FluxSums a = partial_sums[own], b = partial_sums[own + half_size];
            partial_sums[own] = FluxSums(a.emitted + b.emitted, a.absorbed + b.absorbed, a.deposited + b.deposited,
                                         a.escaped + b.escaped, a.lost + b.lost, 0.0, 0.0, 0.0);
        }
    }
    if (own == 0u && invocation_index() < parameters.photon_count)
        sums[invocation_index() / GROUP_SIZE] = partial_sums[0];
}
