#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The list of photons to splat: those stored, without direct ones where shadow rays stand for them.

layout(local_size_x = 64) in;

#include <StoredParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
uniform Parameters { StoredParameters parameters; };
readonly buffer Photons;
buffer StoredPhotons;
readonly buffer PhotonRange;

void main() {
    uint index = invocation_index();
    if (index >= min(parameters.count, photon_end)) return;
    uint flags = photons[index].flags;
    if ((flags & PHOTON_STORED) == 0u) return;
    if ((flags & PHOTON_DIRECT) != 0u && parameters.takes_direct == 0u) return;
    stored_photons[atomicAdd(stored_count, 1u)] = index;
    if ((flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u) atomicAdd(global_photon_count, 1u);
    if ((flags & PHOTON_INDIRECT) != 0u) atomicAdd(indirect_count, 1u);
}
