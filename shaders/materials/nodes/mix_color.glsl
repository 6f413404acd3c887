// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/hsv.glsl"

float blend_overlay(float factor, float a, float b) {
    return a < 0.5 ? a * (1.0 - factor + 2.0 * factor * b)
                   : 1.0 - (1.0 - factor + 2.0 * factor * (1.0 - b)) * (1.0 - a);
}

float blend_divide(float factor, float a, float b) { return b != 0.0 ? (1.0 - factor) * a + factor * a / b : a; }

float blend_dodge(float factor, float a, float b) {
    float rest = 1.0 - factor * b;
    if (a == 0.0) return a;
    return rest <= 0.0 ? 1.0 : min(a / rest, 1.0);
}

float blend_burn(float factor, float a, float b) {
    float rest = 1.0 - factor + factor * b;
    return rest <= 0.0 ? 0.0 : clamp(1.0 - (1.0 - a) / rest, 0.0, 1.0);
}

vec3 blend_soft_light(float factor, vec3 a, vec3 b) {
    vec3 screen = 1.0 - (1.0 - b) * (1.0 - a);
    return mix(a, (1.0 - a) * b * a + a * screen, factor);
}

vec3 blend_hue(float factor, vec3 a, vec3 b) {
    vec3 hsv = rgb_to_hsv(a), other = rgb_to_hsv(b);
    return other.y != 0.0 ? mix(a, hsv_to_rgb(vec3(other.x, hsv.yz)), factor) : a;
}

vec3 blend_saturation(float factor, vec3 a, vec3 b) {
    vec3 hsv = rgb_to_hsv(a), other = rgb_to_hsv(b);
    return hsv.y != 0.0 ? hsv_to_rgb(vec3(hsv.x, mix(hsv.y, other.y, factor), hsv.z)) : a;
}

vec3 blend_color(float factor, vec3 a, vec3 b) {
    vec3 hsv = rgb_to_hsv(a), other = rgb_to_hsv(b);
    return other.y != 0.0 ? mix(a, hsv_to_rgb(vec3(other.xy, hsv.z)), factor) : a;
}

vec3 blend_value(float factor, vec3 a, vec3 b) {
    vec3 hsv = rgb_to_hsv(a), other = rgb_to_hsv(b);
    return hsv_to_rgb(vec3(hsv.xy, mix(hsv.z, other.z, factor)));
}

// A function for each blend type, of this node and of that of before Blender 3.4.
#define BLEND(function, older, expression) \
    void function(int clamp_factor, int clamp_result, float factor, vec3 a, vec3 b, out vec3 result) { \
        if (clamp_factor != 0) factor = clamp(factor, 0.0, 1.0); \
        result = expression; \
        if (clamp_result != 0) result = clamp(result, 0.0, 1.0); \
    } \
    void older(int use_clamp, float factor, vec3 a, vec3 b, out vec3 result) { \
        function(1, use_clamp, factor, a, b, result); \
    }
BLEND(node_mix_color_mix, node_mix_rgb_mix, mix(a, b, factor))
BLEND(node_mix_color_darken, node_mix_rgb_darken, mix(a, min(a, b), factor))
BLEND(node_mix_color_multiply, node_mix_rgb_multiply, mix(a, a *b, factor))
BLEND(node_mix_color_burn, node_mix_rgb_burn,
      vec3(blend_burn(factor, a.r, b.r), blend_burn(factor, a.g, b.g), blend_burn(factor, a.b, b.b)))
BLEND(node_mix_color_lighten, node_mix_rgb_lighten, mix(a, max(a, b), factor))
BLEND(node_mix_color_screen, node_mix_rgb_screen, 1.0 - (1.0 - factor * b) * (1.0 - a))
BLEND(node_mix_color_dodge, node_mix_rgb_dodge,
      vec3(blend_dodge(factor, a.r, b.r), blend_dodge(factor, a.g, b.g), blend_dodge(factor, a.b, b.b)))
BLEND(node_mix_color_add, node_mix_rgb_add, a + factor * b)
BLEND(node_mix_color_overlay, node_mix_rgb_overlay,
      vec3(blend_overlay(factor, a.r, b.r), blend_overlay(factor, a.g, b.g), blend_overlay(factor, a.b, b.b)))
BLEND(node_mix_color_soft_light, node_mix_rgb_soft_light, blend_soft_light(factor, a, b))
BLEND(node_mix_color_linear_light, node_mix_rgb_linear_light, a + factor * (2.0 * b - 1.0))
BLEND(node_mix_color_difference, node_mix_rgb_difference, mix(a, abs(a - b), factor))
BLEND(node_mix_color_exclusion, node_mix_rgb_exclusion, max(mix(a, a + b - 2.0 * a * b, factor), 0.0))
BLEND(node_mix_color_subtract, node_mix_rgb_subtract, a - factor * b)
BLEND(node_mix_color_divide, node_mix_rgb_divide,
      vec3(blend_divide(factor, a.r, b.r), blend_divide(factor, a.g, b.g), blend_divide(factor, a.b, b.b)))
BLEND(node_mix_color_hue, node_mix_rgb_hue, blend_hue(factor, a, b))
BLEND(node_mix_color_saturation, node_mix_rgb_saturation, blend_saturation(factor, a, b))
BLEND(node_mix_color_color, node_mix_rgb_color, blend_color(factor, a, b))
BLEND(node_mix_color_value, node_mix_rgb_value, blend_value(factor, a, b))
#undef BLEND
