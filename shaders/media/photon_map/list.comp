#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Lists the photons that media have scattered. Where shadow rays bring direct light, photons straight from a light are
// left out, and counted.

layout(local_size_x = 64) in;

#include <ListMediumPhotonsParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/photon.glsl"
#include "common/path_depth.glsl"
uniform Parameters { ListMediumPhotonsParameters parameters; };
readonly buffer Photons;
readonly buffer PhotonRange;
buffer MediumPhotons;
#include "media/photon_map/straight_photons.glsl"

void main() {
    uint index = invocation_index();
    if (index >= min(parameters.count, photon_end) || (photons[index].bounce_counts & PHOTON_IN_MEDIUM) == 0u) return;
    if (iteration.next_event != 0u && (photons[index].flags & PHOTON_DIRECT) != 0u) {
        atomicAdd(direct_photon_count, 1u);
        return;
    }
    if (has_come_straight(index)) atomicAdd(straight_photon_count, 1u);
    medium_photons[atomicAdd(medium_photon_count, 1u)] = index;
}
