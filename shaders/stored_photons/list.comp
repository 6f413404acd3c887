#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The list of photons to splat: those stored, without direct ones where shadow rays stand for them.

layout(local_size_x = 64) in;

#include <StoredParameters>
#include "common/invocation.glsl"
#include "common/photon.glsl"
layout(std140, binding = 0) uniform Parameters { StoredParameters parameters; };
layout(std430, binding = 0) readonly buffer Photons;
layout(std430, binding = 1) buffer StoredPhotons;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint flags = photons[index].flags;
    if ((flags & PHOTON_STORED) == 0u || (parameters.indirect_only != 0u && (flags & PHOTON_DIRECT) != 0u)) return;
    stored_photons[atomicAdd(stored_count, 1u)] = index;
    if ((flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u) atomicAdd(diffused_count, 1u);
}
