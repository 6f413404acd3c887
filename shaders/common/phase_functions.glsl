// SPDX-License-Identifier: GPL-3.0-or-later
// Phase functions of media. The includer includes materials/medium.glsl and declares the block PhaseFunctions before.

#include <PhaseFunctionKinds>

float henyey_greenstein(float g, float cosine) {
    float denominator = max(1.0 + g * (g - 2.0 * cosine), 1e-7);
    return (1.0 - g * g) / (4.0 * PI * denominator * sqrt(denominator));
}

// In 1/sr. cosine: between the directions of the light before and after.
float phase_function_value(PhaseFunction f, float cosine) { return henyey_greenstein(f.parameters.x, cosine); }

// The cosine of the angle by which light is scattered, with the density phase_function_value.
float sample_phase_function(PhaseFunction f, vec2 u) {
    float g = f.parameters.x;
    if (abs(g) < 1e-3) return 1.0 - 2.0 * u.x;
    float s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u.x);
    return clamp((1.0 + g * g - s * s) / (2.0 * g), -1.0, 1.0);
}

// Sum over the media of a path of scattering coefficient times phase function, 1/(m sr).
vec3 scattered_phase(uint flags, float cosine) {
    vec3 sum = vec3(0.0);
    uint bits = medium_bits(), set = flags >> FIRST_MEDIUM;
    for (bool world = false; !world;) {
        world = set == 0u;
        Medium medium = media[next_medium(set, bits)];
        for (uint k = 0u; k < medium.function_count; ++k) {
            PhaseFunction f = phase_functions[medium.first_function + k];
            sum += f.scattering * phase_function_value(f, cosine);
        }
    }
    return sum;
}
