// SPDX-License-Identifier: GPL-3.0-or-later
// Color ramps and curves, tabulated as Cycles does; `table` is where theirs starts in material_data.
#include "materials/data.glsl"

#include <CurveTables>
const uint RAMP_WIDTH = 4u;

vec4 ramp_entry(uint table, uint i) {
    uint start = table + RAMP_WIDTH * i;
    return vec4(material_data[start], material_data[start + 1u], material_data[start + 2u], material_data[start + 3u]);
}

void node_val_to_rgb(int constant, uint table, float factor, out vec3 color, out float alpha) {
    float place = clamp(factor, 0.0, 1.0) * float(ENTRIES - 1u);
    uint i = min(uint(place), ENTRIES - 1u);  // a factor that is no number leads anywhere
    vec4 value = ramp_entry(table, i);
    if (constant == 0) value = mix(value, ramp_entry(table, min(i + 1u, ENTRIES - 1u)), place - float(i));
    color = value.rgb;
    alpha = value.a;
}

// A curve's table: where its range begins and ends, then the values of `channels` curves side by side.
float curve_value(uint table, uint channels, uint channel, int extrapolate, float x) {
    float low = material_data[table], high = material_data[table + 1u];
    uint first = table + 2u + channel;
    const float last = float(ENTRIES - 1u);
    float place = (x - low) / max(high - low, 1e-20) * last;
    float inside = clamp(place, 0.0, last);
    uint i = min(uint(inside), ENTRIES - 2u);
    float a = material_data[first + channels * i], b = material_data[first + channels * (i + 1u)];
    return mix(a, b, (extrapolate != 0 ? place : inside) - float(i));
}

vec3 curve_values(uint table, int extrapolate, vec3 x) {
    return vec3(curve_value(table, 3u, 0u, extrapolate, x.x), curve_value(table, 3u, 1u, extrapolate, x.y),
                curve_value(table, 3u, 2u, extrapolate, x.z));
}

void node_rgb_curve(int extrapolate, uint table, float factor, vec3 color, out vec3 result) {
    result = mix(color, curve_values(table, extrapolate, color), factor);
}

void node_vector_curve(int extrapolate, uint table, float factor, vec3 vector, out vec3 result) {
    result = mix(vector, curve_values(table, extrapolate, vector), factor);
}

void node_float_curve(int extrapolate, uint table, float factor, float value, out float result) {
    result = mix(value, curve_value(table, 1u, 0u, extrapolate, value), factor);
}
