// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/fractal_noise.glsl"

// Moves a lookup far away, to values that have nothing to do with those at p. Rounded step by step as in Cycles:
// fine octaves magnify the last bit.
vec4 noise_offset(int dimensions, float seed) {
    vec4 random = vec4(hash_to_unit(seed), 0.0, 0.0, 0.0);
    if (dimensions > 1) {
        random = vec4(hash_to_unit(vec2(seed, 0.0)), hash_to_unit(vec2(seed, 1.0)), hash_to_unit(vec2(seed, 2.0)),
                      hash_to_unit(vec2(seed, 3.0)));
    }
    precise vec4 offset = 100.0 * random + 100.0;
    return offset;
}

void node_tex_noise(int noise_dimensions, int noise_type, int normalize_sum, vec3 vector, float w, float scale,
                    float detail, float roughness, float lacunarity, float offset, float gain, float distortion,
                    out float fac, out vec3 color) {
    int dimensions = noise_dimensions + 1;
    detail = clamp(detail, 0.0, 15.0);
    roughness = max(roughness, 0.0);
    vec4 p = dimensions == 1 ? vec4(w * scale, 0.0, 0.0, 0.0) : vec4(vector * scale, w * scale);
    // No turns without distortion: a loop is skipped where a branch may not be.
    int moved = distortion != 0.0 ? dimensions : 0;
    vec4 shift = vec4(0.0);
    for (int axis = 0; axis < moved; ++axis) {
        float amount = distortion * signed_noise(dimensions, p + noise_offset(dimensions, float(axis)));
        shift += amount * vec4(equal(ivec4(axis), ivec4(0, 1, 2, 3)));
    }
    p += shift;
    fac = fractal_noise(dimensions, noise_type, normalize_sum, p, detail, roughness, lacunarity, offset, gain);
    // A loop of its own, that the compiler drops where the color is not used.
    color = vec3(fac, 0.0, 0.0);
    for (int channel = 1; channel < 3; ++channel) {
        vec4 far = p + noise_offset(dimensions, float(dimensions + channel - 1));
        float value =
            fractal_noise(dimensions, noise_type, normalize_sum, far, detail, roughness, lacunarity, offset, gain);
        if (channel == 1) color.g = value;
        else color.b = value;
    }
}
