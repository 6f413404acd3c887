// SPDX-License-Identifier: GPL-3.0-or-later
// Where sums for passes of light lie: for each pixel of the band, laid out as those of sums.glsl, by the Scatter of its
// first surface, direct and indirect; of caustics at its importons and at the ends of gathering rays; and of light that
// media scatter straight to the camera, direct and indirect. sums: those that are kept, as flags.
#include <LightSums>
#include <PathHistory>

uint scattered_sum(uint scatter, bool indirect) { return 2u * (scatter - SCATTER_DIFFUSE) + (indirect ? 1u : 0u); }

uint volume_sum(bool indirect) { return VOLUME_DIRECT_SUM + (indirect ? 1u : 0u); }

uint first_light_word(uint pixel, uint sum, uint sums) {
    uint scattered = (sums & LIGHT_SUMS_SCATTERED) != 0u ? SCATTERED_SUMS : 0u;
    uint caustics = (sums & LIGHT_SUMS_CAUSTICS) != 0u ? CAUSTICS_SUMS : 0u;
    uint volume = (sums & LIGHT_SUMS_VOLUME) != 0u ? VOLUME_SUMS : 0u;
    uint left_out = SCATTERED_SUMS - scattered + (sum >= VOLUME_DIRECT_SUM ? CAUSTICS_SUMS - caustics : 0u);
    return 6u * ((scattered + caustics + volume) * pixel + sum - left_out);
}
