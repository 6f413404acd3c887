// SPDX-License-Identifier: GPL-3.0-or-later
// Sums and products of octaves of noise: Ebert et al., Texturing and Modeling (2003), chapter 16 by Musgrave,
// with Cycles' normalization and its blending of a fractional last octave.
#include "materials/nodes/perlin.glsl"

#include <NoiseTypes>

// Dimensions, type and normalize are literals; detail is in [0, 15].
float fractal_noise(int dimensions, int type, int normalize_sum, vec4 p, float detail, float roughness,
                    float lacunarity, float offset, float gain) {
    int last = type == NOISE_RIDGED_MULTIFRACTAL ? int(detail) : int(ceil(detail));
    float scale = 1.0, amplitude = 1.0, total = 0.0, sum = 0.0, weight = 1.0;
    float value = type == NOISE_MULTIFRACTAL ? 1.0 : 0.0;
    for (int octave = 0; octave <= last && weight > 0.001; ++octave) {
        // Scaling p anew or step by step differs by rounding, which large coordinates make visible.
        float noise = signed_noise(dimensions, type == NOISE_FBM ? scale * p : p);
        float fraction = float(octave) <= detail ? 1.0 : fract(detail);
        if (type == NOISE_FBM) {
            sum += noise * amplitude;
            total += amplitude;
            value = mix(value, normalize_sum != 0 ? 0.5 * sum / total + 0.5 : sum, fraction);
        } else if (type == NOISE_MULTIFRACTAL) {
            value *= fraction * amplitude * noise + 1.0;
        } else if (type == NOISE_HETERO_TERRAIN) {
            value += fraction * (noise + offset) * amplitude * (octave == 0 ? 1.0 : value);
        } else if (type == NOISE_HYBRID_MULTIFRACTAL) {
            weight = min(weight, 1.0);
            float signal = (noise + offset) * amplitude;
            value += fraction * weight * signal;
            weight *= gain * signal;
        } else {
            float ridge = offset - abs(noise);
            float signal = ridge * ridge * (octave == 0 ? 1.0 : clamp(gain * sum, 0.0, 1.0));
            value += signal * amplitude;
            sum = signal;
        }
        amplitude *= roughness;
        scale *= lacunarity;
        if (type != NOISE_FBM) p *= lacunarity;
    }
    return value;
}
