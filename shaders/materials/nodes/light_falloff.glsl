// SPDX-License-Identifier: GPL-3.0-or-later

// Strengths that make a light's light fall off by the square of the distance, by the distance, not at all.
// `ray_length` is the distance to the lit point; `smoothing` weakens light near the light.
void node_light_falloff(float strength, float smoothing, float ray_length, out float quadratic, out float linear,
                        out float constant) {
    float length2 = ray_length * ray_length;
    quadratic = smoothing > 0.0 ? strength * length2 / (smoothing + length2) : strength;
    linear = quadratic * ray_length;
    constant = quadratic * length2;
}
