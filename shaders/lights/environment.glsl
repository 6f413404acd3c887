// SPDX-License-Identifier: GPL-3.0-or-later
// Radiance of the environment and directions chosen by it. Needs the members world_radiance, environment_width and
// environment_height of the parameters; width 0 is a constant world.

#include "common/sampling.glsl"
layout(binding = 0) uniform sampler2D environment_image;
layout(binding = 1) uniform sampler2D environment_seen;
layout(std430, binding = 7) readonly buffer EnvironmentDistribution { float environment_distribution[]; };

// Cycles' equirectangular map; v grows upwards.
vec2 direction_to_equirectangular(vec3 d) {
    return vec2(0.5 - atan(d.y, d.x) / (2.0 * PI), 1.0 - acos(clamp(d.z, -1.0, 1.0)) / PI);
}

vec3 equirectangular_to_direction(vec2 uv) {
    float azimuth = (0.5 - uv.x) * 2.0 * PI, polar = (1.0 - uv.y) * PI;
    return vec3(sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar));
}

vec3 world_radiance(vec3 direction) {
    if (parameters.environment_width == 0u) return parameters.world_radiance;
    return parameters.world_radiance * textureLod(environment_image, direction_to_equirectangular(direction), 0.0).rgb;
}

// Light Path nodes may show the camera another world than the one that gives light.
vec3 world_radiance(vec3 direction, bool seen) {
    if (parameters.environment_width == 0u) return parameters.world_radiance;
    vec2 at = direction_to_equirectangular(direction);
    vec3 texel;
    if (seen) texel = textureLod(environment_seen, at, 0.0).rgb;
    else texel = textureLod(environment_image, at, 0.0).rgb;
    return parameters.world_radiance * texel;
}

// Without textures: gathering rays then find it so well that no shadow rays are sent to it.
bool environment_is_even() { return parameters.environment_width == 0u; }

// The distribution lists the cumulated shares of the rows, then those of the cells within each row.
uint environment_search(uint first, uint count, float u) {
    uint low = 0u, high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (environment_distribution[first + middle] > u) high = middle;
        else low = middle + 1u;
    }
    return low;
}

float environment_share(uint first, uint index) {
    return environment_distribution[first + index] - (index == 0u ? 0.0 : environment_distribution[first + index - 1u]);
}

// Pdf in 1/sr with which sample_world gives a direction.
float world_pdf(vec3 direction) {
    if (parameters.environment_width == 0u) return 1.0 / (4.0 * PI);
    vec2 uv = direction_to_equirectangular(direction);
    uint width = parameters.environment_width, height = parameters.environment_height;
    uint row = min(uint(uv.y * float(height)), height - 1u), column = min(uint(fract(uv.x) * float(width)), width - 1u);
    float share = environment_share(0u, row) * environment_share(height + row * width, column);
    return share * float(width) * float(height) / (2.0 * PI * PI * max(sin(PI * (1.0 - uv.y)), 1e-6));
}

// A direction toward the world and its pdf in 1/sr.
vec3 sample_world(vec2 u, out float pdf) {
    if (parameters.environment_width == 0u) {
        pdf = 1.0 / (4.0 * PI);
        return sample_sphere(u);
    }
    uint width = parameters.environment_width, height = parameters.environment_height;
    uint row = environment_search(0u, height, u.y);
    float row_share = environment_share(0u, row);
    uint first = height + row * width;
    uint column = environment_search(first, width, u.x);
    float column_share = environment_share(first, column);
    float below_row = row == 0u ? 0.0 : environment_distribution[row - 1u];
    float below_column = column == 0u ? 0.0 : environment_distribution[first + column - 1u];
    vec2 uv = vec2((float(column) + clamp((u.x - below_column) / max(column_share, 1e-20), 0.0, 1.0)) / float(width),
                   (float(row) + clamp((u.y - below_row) / max(row_share, 1e-20), 0.0, 1.0)) / float(height));
    float sine = max(sin(PI * (1.0 - uv.y)), 1e-6);
    pdf = row_share * column_share * float(width) * float(height) / (2.0 * PI * PI * sine);
    return equirectangular_to_direction(uv);
}
