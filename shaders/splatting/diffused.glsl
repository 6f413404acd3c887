// SPDX-License-Identifier: GPL-3.0-or-later
// The diffused photons that importons take, counted for the wide radius.
// The includer declares the storage block of photons[].

layout(std430, binding = 5) buffer DiffusedPhotons { uint diffused_photons[]; };

void count_diffused(uint importon, uint photon, uint counting) {
    if (counting != 0u && (photons[photon].flags & PHOTON_DIFFUSED) != 0u) atomicAdd(diffused_photons[importon], 1u);
}
