// SPDX-License-Identifier: GPL-3.0-or-later
// Where sums of photons by light group lie: for each pixel of the band, for each of so many groups, laid out as those
// of density_estimation/splat_sums/sums.glsl.
#include <LightGroups>

uint first_group_word(uint pixel, uint group, bool final_gather, uint groups) {
    return 12u * (groups * pixel + group) + (final_gather ? 6u : 0u);
}
