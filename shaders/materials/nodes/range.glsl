// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/nodes/safe.glsl"
#include <RangeOptions>

// Between two bounds in either order.
float clamp_range(float value, float a, float b) { return clamp(value, min(a, b), max(a, b)); }

void node_clamp(int clamp_type, float value, float low, float high, out float result) {
    result = clamp_type == CLAMP_MINMAX ? min(max(value, low), high) : clamp_range(value, low, high);
}

float map_range(int interpolation_type, int use_clamp, float value, float from_low, float from_high, float to_low,
                float to_high, float steps) {
    float factor = safe_divide(value - from_low, from_high - from_low);
    if (interpolation_type == RANGE_STEPPED) factor = steps > 0.0 ? floor(factor * (steps + 1.0)) / steps : 0.0;
    if (interpolation_type >= 2) factor = clamp(factor, 0.0, 1.0);
    if (interpolation_type == RANGE_SMOOTHSTEP) factor = factor * factor * (3.0 - 2.0 * factor);
    if (interpolation_type == RANGE_SMOOTHERSTEP)
        factor = factor * factor * factor * (factor * (factor * 6.0 - 15.0) + 10.0);
    float result = to_low + factor * (to_high - to_low);
    return use_clamp != 0 ? clamp_range(result, to_low, to_high) : result;
}

void node_map_range(int interpolation_type, int use_clamp, float value, float from_low, float from_high, float to_low,
                    float to_high, float steps, out float result) {
    if (from_low != from_high)
        result = map_range(interpolation_type, use_clamp, value, from_low, from_high, to_low, to_high, steps);
    else result = use_clamp != 0 ? clamp_range(0.0, to_low, to_high) : 0.0;  // as Cycles, unlike for vectors
}

void node_map_range_vector(int interpolation_type, int use_clamp, vec3 vector, vec3 from_low, vec3 from_high,
                           vec3 to_low, vec3 to_high, vec3 steps, out vec3 result) {
    for (int i = 0; i < 3; i++)
        result[i] = map_range(interpolation_type, use_clamp, vector[i], from_low[i], from_high[i], to_low[i],
                              to_high[i], steps[i]);
}
