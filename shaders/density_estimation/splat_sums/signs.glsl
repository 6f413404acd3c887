// SPDX-License-Identifier: GPL-3.0-or-later
// A random sign for each photon path, by which sums with signs show the variance that photons make (sums.glsl). The
// includer declares the members of SUM_PARAMETERS, of which counting is the seed.

#include "density_estimation/splat_sums/sums.glsl"
#include "common/luminance.glsl"
#include "common/random.glsl"

float photon_sign(uint path) {
    uvec4 key = uvec4(photon_path_of(path), 0u, parameters.counting, STAGE_SPLATTING);
    return (pcg4d(key).x & 0x80000000u) != 0u ? 1.0 : -1.0;
}
