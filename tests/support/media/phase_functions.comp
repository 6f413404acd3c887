#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Values and samples of a phase function, for tests.

layout(local_size_x = 64) in;

#include <PhaseFunctionsParameters>
#include "common/invocation.glsl"
#include "common/phase_functions.glsl"
uniform Parameters { PhaseFunctionsParameters parameters; };
readonly buffer Cosines { float cosines[]; };
writeonly buffer Values { float values[]; };
writeonly buffer Samples { float samples[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    PhaseFunction f = PhaseFunction(vec3(1.0), parameters.kind, parameters.parameters);
    values[index] = evaluate_phase_function(f, cosines[index]);
    samples[index] = sample_phase_function(f, (float(index) + 0.5) / float(parameters.count));
}
