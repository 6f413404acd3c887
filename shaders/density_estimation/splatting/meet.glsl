// SPDX-License-Identifier: GPL-3.0-or-later
// A photon meets an importon. Only what decides whether it is near is read of most pairs.
// The includer declares the storage blocks of photons[] and importons[] and the parameters.

#include "common/iteration.glsl"
#include "density_estimation/splat_sums/roulette.glsl"
#include "density_estimation/splat_sums/add.glsl"
#include "density_estimation/splat_sums/light.glsl"

void meet(uint importon, uint photon) {
    if (rejected(photons[photon].path, importon)) return;
    vec3 offset = photons[photon].position - importons[importon].position;
    uint flags = photons[photon].flags;
    float radius =
        photon_radius(flags, importons[importon].minimum_radius, importons[importon].radius, iteration.wide_radius);
    if (!within_reach(importons[importon].gathers, offset, radius, flags)) return;
    Estimate estimate;
    uint stands_for;
    if (!density_estimate(IMPORTON_OF(importons[importon], importon), arrived_counts(importon), photon, estimate,
                          stands_for))
        return;
    add_splat(importon, photon, estimate.radiance, stands_for);
    if (parameters.light_sums != 0u) add_light(importon, importons[importon], photon, flags, estimate);
}
