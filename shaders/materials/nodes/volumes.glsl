// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes as Cycles has them: coefficients, which take the place of the emission, and the surface of a volume alone.

#include <Volumes>
#include "materials/nodes/spectrum.glsl"

void node_volume_boundary(inout ClosureBuilder builder, float weight) {
    builder.closure.transparent += vec3(weight);
    builder.closure.flags |= CLOSURE_ABSENT;
}

void add_coefficient(inout ClosureBuilder builder, float weight, vec3 coefficient) {
    builder.closure.emission += weight * coefficient;
}

void node_volume_absorption(inout ClosureBuilder builder, float weight, vec3 color, float density) {
    add_coefficient(builder, weight, max(density, 0.0) * max(1.0 - color, 0.0));
}

// Weight of Draine's phase function in the mixture that stands for Mie's, by the diameter of droplets, micrometers
// (Jendersie and d'Eon 2023, An Approximate Mie Scattering Function for Fog and Cloud Rendering).
float mie_draine_weight(float diameter) {
    float d = max(diameter, 1e-6), l = log(d);
    if (d <= 0.1) return 0.252977 - 312.983 * pow(d, 4.3);
    if (d < 1.5) return 0.146209 * cos(3.38707 * l + 2.11193) + 0.316072 + 0.0778917 * l;
    if (d < 5.0) return 0.026914 * (l - cos(5.68947 * (log(l) - 0.0292149))) + 0.376475;
    return exp(-0.599085 / (d - 0.641583) - 0.665888);
}

// Fraction of the scattering coefficient that belongs to the phase function.
float phase_weight(int phase, int mie_lobe, float diameter) {
    if (phase != VOLUME_PHASE_MIE) return 1.0;
    float draine = clamp(mie_draine_weight(diameter), 0.0, 1.0);
    return mie_lobe == MIE_LOBE_DRAINE ? draine : 1.0 - draine;
}

void node_volume_scatter(inout ClosureBuilder builder, float weight, int phase, int mie_lobe, vec3 color, float density,
                         float anisotropy, float ior, float backscatter, float alpha, float diameter) {
    weight *= phase_weight(phase, mie_lobe, diameter);
    add_coefficient(builder, weight, max(density, 0.0) * max(color, 0.0));
}

void node_volume_coefficients(inout ClosureBuilder builder, float weight, int coefficient, int phase, int mie_lobe,
                              vec3 absorption, vec3 scatter, vec3 emission, float anisotropy, float ior,
                              float backscatter, float alpha, float diameter) {
    if (coefficient == COEFFICIENT_ABSORPTION) add_coefficient(builder, weight, max(absorption, 0.0));
    else if (coefficient == COEFFICIENT_EMISSION) add_coefficient(builder, weight, max(emission, 0.0));
    else add_coefficient(builder, weight * phase_weight(phase, mie_lobe, diameter), max(scatter, 0.0));
}

// Radiance by length of gas that glows by its temperature, kelvin, between 0 and the law of Stefan and Boltzmann.
vec3 blackbody_emission(float intensity, vec3 tint, float temperature) {
    const float SCALE = 5.670373e-8 * 1e-6 / PI;
    if (intensity <= 0.0) return vec3(0.0);
    float t = max(temperature, 0.0);
    vec3 color;
    node_blackbody(t, color);
    return tint * color * SCALE * mix(1.0, t * t * t * t, intensity);
}

void node_volume_principled(inout ClosureBuilder builder, float weight, int coefficient, vec3 color, vec3 color_grid,
                            float density, float density_grid, float anisotropy, vec3 absorption_color,
                            float emission_strength, vec3 emission_color, float blackbody_intensity,
                            vec3 blackbody_tint, float temperature, float temperature_grid) {
    float dense = max(density, 0.0) * max(density_grid, 0.0);
    vec3 scattering = color * color_grid;
    if (coefficient == COEFFICIENT_SCATTERING) add_coefficient(builder, weight * dense, max(scattering, 0.0));
    else if (coefficient == COEFFICIENT_ABSORPTION)
        add_coefficient(builder, weight * dense,
                        max(1.0 - scattering, 0.0) * max(1.0 - sqrt(max(absorption_color, 0.0)), 0.0));
    else
        add_coefficient(
            builder, weight,
            max(emission_strength, 0.0) * emission_color
                + blackbody_emission(blackbody_intensity, blackbody_tint, temperature * max(temperature_grid, 0.0)));
}
