// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/hsv.glsl"

float blend_overlay(float factor, float a, float b) {
    return a < 0.5 ? a * (1.0 - factor + 2.0 * factor * b)
                   : 1.0 - (1.0 - factor + 2.0 * factor * (1.0 - b)) * (1.0 - a);
}

float blend_divide(float factor, float a, float b) {
    return b != 0.0 ? (1.0 - factor) * a + factor * a / b : a;
}

float blend_dodge(float factor, float a, float b) {
    float rest = 1.0 - factor * b;
    if (a == 0.0) return a;
    return rest <= 0.0 ? 1.0 : min(a / rest, 1.0);
}

float blend_burn(float factor, float a, float b) {
    float rest = 1.0 - factor + factor * b;
    return rest <= 0.0 ? 0.0 : clamp(1.0 - (1.0 - a) / rest, 0.0, 1.0);
}

vec3 blend(int blend_type, float factor, vec3 a, vec3 b) {
    switch (blend_type) {
    case 0: return mix(a, b, factor);                                    // MIX
    case 1: return mix(a, min(a, b), factor);                            // DARKEN
    case 2: return mix(a, a * b, factor);                                // MULTIPLY
    case 3: return vec3(blend_burn(factor, a.r, b.r), blend_burn(factor, a.g, b.g), blend_burn(factor, a.b, b.b)); // BURN
    case 4: return mix(a, max(a, b), factor);                            // LIGHTEN
    case 5: return 1.0 - (1.0 - factor * b) * (1.0 - a);                 // SCREEN
    case 6: return vec3(blend_dodge(factor, a.r, b.r), blend_dodge(factor, a.g, b.g), blend_dodge(factor, a.b, b.b)); // DODGE
    case 7: return a + factor * b;                                       // ADD
    case 8: return vec3(blend_overlay(factor, a.r, b.r), blend_overlay(factor, a.g, b.g), blend_overlay(factor, a.b, b.b)); // OVERLAY
    case 9: {                                                            // SOFT_LIGHT
        vec3 screen = 1.0 - (1.0 - b) * (1.0 - a);
        return mix(a, (1.0 - a) * b * a + a * screen, factor);
    }
    case 10: return a + factor * (2.0 * b - 1.0);                        // LINEAR_LIGHT
    case 11: return mix(a, abs(a - b), factor);                          // DIFFERENCE
    case 12: return max(mix(a, a + b - 2.0 * a * b, factor), 0.0);       // EXCLUSION
    case 13: return a - factor * b;                                      // SUBTRACT
    case 14: return vec3(blend_divide(factor, a.r, b.r), blend_divide(factor, a.g, b.g), blend_divide(factor, a.b, b.b)); // DIVIDE
    }
    vec3 hsv = rgb_to_hsv(a), other = rgb_to_hsv(b);
    switch (blend_type) {
    case 15: return other.y != 0.0 ? mix(a, hsv_to_rgb(vec3(other.x, hsv.yz)), factor) : a; // HUE
    case 16: return hsv.y != 0.0 ? hsv_to_rgb(vec3(hsv.x, mix(hsv.y, other.y, factor), hsv.z)) : a; // SATURATION
    case 17: return other.y != 0.0 ? mix(a, hsv_to_rgb(vec3(other.xy, hsv.z)), factor) : a; // COLOR
    default: return hsv_to_rgb(vec3(hsv.xy, mix(hsv.z, other.z, factor))); // VALUE
    }
}

void node_mix_color(
    int blend_type, int clamp_factor, int clamp_result, float factor, vec3 a, vec3 b, out vec3 result) {
    if (clamp_factor != 0) factor = clamp(factor, 0.0, 1.0);
    result = blend(blend_type, factor, a, b);
    if (clamp_result != 0) result = clamp(result, 0.0, 1.0);
}

// The node of before Blender 3.4.
void node_mix_rgb(int blend_type, int use_clamp, float factor, vec3 color1, vec3 color2, out vec3 color) {
    node_mix_color(blend_type, 1, use_clamp, factor, color1, color2, color);
}
