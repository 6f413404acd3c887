// SPDX-License-Identifier: GPL-3.0-or-later
// Photons add to the sums of importons, many threads at once.
// The includer declares the storage blocks of photons[] and importons[] and the members of SUM_PARAMETERS
// (integrator/density_estimation/splat_sums.py).

#include "density_estimation/splat_sums/add_quanta.glsl"

// Threads that meet here write the same mark.
void add_splat(uint importon, uint photon, vec3 radiance, uint stands_for) {
    photons[photon].depth = photons[photon].depth | PHOTON_CONTRIBUTED;
    bool final_gather = (importons[importon].gathers & FINAL_GATHER_HIT) != 0u;
    add_radiance_quanta(importon, final_gather, radiance);
    if (parameters.counting == 0u) return;
    float quanta = luminance(radiance) * parameters.quanta;
    add_signed_quanta(signed_place(importon, final_gather), photon_sign(photons[photon].path) * quanta);
    if ((photons[photon].flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u)
        atomicAdd(photon_counts[global_photon_place(importon)], 1u);
    else if (!final_gather) atomicAdd(photon_counts[caustic_place(importon)], stands_for);
}
