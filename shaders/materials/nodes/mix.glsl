// SPDX-License-Identifier: GPL-3.0-or-later

void node_mix_float(int clamp_factor, float factor, float a, float b, out float result) {
    result = mix(a, b, clamp_factor != 0 ? clamp(factor, 0.0, 1.0) : factor);
}

void node_mix_vector(int clamp_factor, float factor, vec3 a, vec3 b, out vec3 result) {
    result = mix(a, b, clamp_factor != 0 ? clamp(factor, 0.0, 1.0) : factor);
}

void node_mix_vector_non_uniform(int clamp_factor, vec3 factor, vec3 a, vec3 b, out vec3 result) {
    result = mix(a, b, clamp_factor != 0 ? clamp(factor, 0.0, 1.0) : factor);
}
