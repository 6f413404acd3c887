#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The list of photons to splat: those stored, from a first segment on.

layout(local_size_x = 64) in;

#include <StoredParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
layout(std140, binding = 0) uniform Parameters { StoredParameters parameters; };
layout(std430, binding = 0) readonly buffer Photons { Photon photons[]; };
layout(std430, binding = 1) buffer StoredPhotons { uint stored_count; uint diffused_count; uint stored_photons[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint slot = parameters.first_slot + index;
    uint flags = photons[slot].flags;
    if ((flags & PHOTON_STORED) == 0u) return;
    stored_photons[atomicAdd(stored_count, 1u)] = slot;
    if ((flags & PHOTON_DIFFUSED) != 0u) atomicAdd(diffused_count, 1u);
}
