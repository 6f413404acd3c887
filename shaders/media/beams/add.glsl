// SPDX-License-Identifier: GPL-3.0-or-later
// A photon beam adds to the sums of a pixel, many threads at once. The includer declares the members of SUM_PARAMETERS
// (integrator/density_estimation/splat_sums.py).

#include "density_estimation/splat_sums/add_quanta.glsl"
#include "density_estimation/splat_sums/add_light.glsl"

// Threads that meet here write the same mark.
void add_beam(uint pixel, PhotonBeam beam, vec3 radiance) {
    if (!(largest(radiance) > 0.0)) return;
    photons[beam.photon].depth = photons[beam.photon].depth | PHOTON_CONTRIBUTED;
    add_radiance_quanta(pixel, false, radiance);
    if ((parameters.light_sums & LIGHT_SUMS_GROUPS) != 0u) add_to_group_sum(pixel, beam.light_group, false, radiance);
    if ((parameters.light_sums & LIGHT_SUMS_VOLUME) != 0u)
        add_to_light_sum(pixel, volume_sum(is_indirect(beam.flags, beam.bounce_counts, beam.depth)), radiance);
    if ((parameters.light_sums & LIGHT_SUMS_CAUSTICS) != 0u && (beam.flags & PHOTON_CAUSTIC) != 0u)
        add_to_light_sum(pixel, CAUSTICS_SUM, radiance);
    if (parameters.counting == 0u) return;
    atomicAdd(beam_pair_count, 1u);
    add_signed_quanta(signed_place(pixel, false), photon_sign(beam.path) * luminance(radiance) * parameters.quanta);
}
