// SPDX-License-Identifier: GPL-3.0-or-later
// Where the values of a band's passes lie (scene/passes.py). Needs the members passes and pixels of the
// parameters; pixels are those of the band.

#include "common/iteration.glsl"
#include <Passes>
buffer PassValues;
// Paths of a band before they are scattered: their radiance, and PASS_PATH flags.
buffer PassPaths { vec4 pass_paths[]; };
const uint PASS_PATH_HIT = 1u, PASS_PATH_CAMERA_TRANSPARENT = 2u, PASS_PATH_DENOISED = 4u;

bool is_on(uint which) { return (parameters.passes & (1u << which)) != 0u; }

// Index of the first value of a pixel in a pass. The values of a pass are stored together.
uint place_of(uint which, uint pixel) {
    uint before = 0u;
    for (uint other = 0u; other < which; other++) before += is_on(other) ? PASS_CHANNELS[other] : 0u;
    return before * parameters.pixels + PASS_CHANNELS[which] * pixel;
}

// Adds the value of one path to a pass that accumulates as SUM, at any segment.
void add_to_pass(uint which, uint pixel, vec3 value) {
    if (!is_on(which)) return;
    uint place = place_of(which, pixel);
    for (uint channel = 0u; channel < PASS_CHANNELS[which]; channel++)
        pass_values[place + channel] += value[channel] / float(iteration.number_in_film);
}
