#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Prepares the passes of a band for an iteration: sums fade by its weight.

layout(local_size_x = 64) in;

#include <PassParameters>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
uniform Parameters { PassParameters parameters; };
#include "film/passes.glsl"
// iterations in the means; those with a surface
writeonly buffer PassCounts;

void main() {
    uint index = invocation_index();
    if (index >= parameters.pixels) return;
    bool first = iteration.number_in_film == 1u;
    if (first) pass_counts[index] = uvec2(0u);
    float kept = float(iteration.number_in_film - 1u) / float(iteration.number_in_film);
    for (uint which = 0u; which < PASS_COUNT; which++) {
        bool is_sum = PASS_ACCUMULATION[which] == ACCUMULATION_SUM;
        if (!is_on(which) || !(first || is_sum)) continue;
        for (uint channel = 0u; channel < PASS_CHANNELS[which]; channel++) {
            uint place = place_of(which, index) + channel;
            pass_values[place] = is_sum ? (first ? 0.0 : kept * pass_values[place]) : PASS_NOTHING[which];
        }
    }
    add_to_pass(PASS_DEBUG_SAMPLE_COUNT, index, vec3(1.0));
}
