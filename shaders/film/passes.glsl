// SPDX-License-Identifier: GPL-3.0-or-later
// Where the values of a band's passes lie (scene/passes.py). Needs the members passes and pixels of the
// parameters; pixels are those of the band.

#include "common/iteration.glsl"
#include <Passes>
buffer PassValues;
// Of a band's paths before they are scattered: radiance, and what they are, as flags.
buffer PassPaths { vec4 pass_paths[]; };
const uint PASS_PATH_HIT = 1u, PASS_PATH_STRAIGHT = 2u, PASS_PATH_DENOISED = 4u;

bool is_on(uint which) { return (parameters.passes & (1u << which)) != 0u; }

// Where a pixel's values of a pass begin: those of a pass lie together.
uint place_of(uint which, uint pixel) {
    uint before = 0u;
    for (uint other = 0u; other < which; other++) before += is_on(other) ? PASS_CHANNELS[other] : 0u;
    return before * parameters.pixels + PASS_CHANNELS[which] * pixel;
}

// To what accumulates as a sum, what one path of so many iterations finds.
void add_to_pass(uint which, uint pixel, vec3 value) {
    if (!is_on(which)) return;
    uint place = place_of(which, pixel);
    for (uint channel = 0u; channel < PASS_CHANNELS[which]; channel++)
        pass_values[place + channel] += value[channel] / float(iteration.number_in_film);
}
