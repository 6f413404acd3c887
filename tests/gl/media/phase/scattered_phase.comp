#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Scattering of all media of a path, and phase functions that are chosen for it, for tests.

layout(local_size_x = 64) in;

#include <ScatteredPhaseParameters>
#include "common/invocation.glsl"
readonly buffer Media;
#include "materials/medium.glsl"
#include "common/phase_functions.glsl"
uniform Parameters { ScatteredPhaseParameters parameters; };
writeonly buffer Results { vec4 results[]; };

// In each result, the coefficient by the cosine and the anisotropy of the phase function that is chosen.
void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    float u = (float(index) + 0.5) / float(parameters.count);
    PlaceOnRay at = PlaceOnRay(vec3(0.0), vec3(0.0, 0.0, 1.0), 0.0);
    PhaseFunction chosen = sample_path_phase_function(parameters.flags, at, parameters.weight, u);
    results[index] = vec4(scattered_phase(parameters.flags, at, parameters.cosine).xy, chosen.parameters.x, u);
}
