// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/luminance.glsl"
#include "materials/nodes/hsv.glsl"

void node_invert(float factor, vec3 color, out vec3 result) { result = mix(color, 1.0 - color, factor); }

void node_gamma(vec3 color, float gamma, out vec3 result) {
    for (int i = 0; i < 3; i++) result[i] = color[i] > 0.0 ? pow(color[i], gamma) : color[i];
    if (gamma == 0.0) result = vec3(1.0);
}

void node_bright_contrast(vec3 color, float bright, float contrast, out vec3 result) {
    result = max((1.0 + contrast) * color + bright - 0.5 * contrast, 0.0);
}

void node_hue_saturation(float hue, float saturation, float value, float factor, vec3 color, out vec3 result) {
    vec3 hsv = rgb_to_hsv(color);
    hsv.x = fract(hsv.x + hue + 0.5);
    hsv.y = clamp(hsv.y * saturation, 0.0, 1.0);
    hsv.z *= value;
    result = max(mix(color, hsv_to_rgb(hsv), factor), 0.0);
}

void node_rgb_to_bw(vec3 color, out float value) { value = luminance(color); }
