// SPDX-License-Identifier: GPL-3.0-or-later
// Radiance of the environment and directions chosen by it. An environment_width of 0 is a
// constant world.

#include "common/iteration.glsl"
#include "common/sampling.glsl"
uniform sampler2D environment_image;
uniform sampler2D environment_visible;
readonly buffer EnvironmentDistribution { float environment_distribution[]; };

// Cycles' equirectangular map; v grows upwards.
vec2 direction_to_equirectangular(vec3 d) {
    return vec2(0.5 - atan(d.y, d.x) / (2.0 * PI), 1.0 - acos(clamp(d.z, -1.0, 1.0)) / PI);
}

vec3 equirectangular_to_direction(vec2 uv) {
    float azimuth = (0.5 - uv.x) * 2.0 * PI, polar = (1.0 - uv.y) * PI;
    return vec3(sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar));
}

vec3 world_radiance(vec3 direction) {
    if (iteration.environment_width == 0u) return iteration.world_radiance;
    return iteration.world_radiance * textureLod(environment_image, direction_to_equirectangular(direction), 0.0).rgb;
}

// Light Path nodes may show the camera another world than the one that gives light.
vec3 world_radiance(vec3 direction, bool seen) {
    if (iteration.environment_width == 0u) return iteration.world_radiance;
    vec2 at = direction_to_equirectangular(direction);
    vec3 texel;
    if (seen) texel = textureLod(environment_visible, at, 0.0).rgb;
    else texel = textureLod(environment_image, at, 0.0).rgb;
    return iteration.world_radiance * texel;
}

// Without textures: gathering rays then find it so well that no shadow rays are sent to it.
bool environment_is_even() { return iteration.environment_width == 0u; }

// A distribution lists the cumulated probabilities of the rows, then those of the cells within each row.
struct DirectionTable {
    uint first;
    uint width;
    uint height;
};

DirectionTable world_table() { return DirectionTable(0u, iteration.environment_width, iteration.environment_height); }

uint environment_search(uint first, uint count, float u) {
    uint low = 0u, high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (environment_distribution[first + middle] > u) high = middle;
        else low = middle + 1u;
    }
    return low;
}

float environment_probability(uint first, uint index) {
    return environment_distribution[first + index] - (index == 0u ? 0.0 : environment_distribution[first + index - 1u]);
}

uvec2 table_cell(DirectionTable table, vec2 uv) {
    return uvec2(min(uint(fract(uv.x) * float(table.width)), table.width - 1u),
                 min(uint(uv.y * float(table.height)), table.height - 1u));
}

// Pdf in 1/sr with which sample_table gives a direction.
float table_pdf(DirectionTable table, vec3 direction) {
    vec2 uv = direction_to_equirectangular(direction);
    uvec2 cell = table_cell(table, uv);
    float probability = environment_probability(table.first, cell.y)
                        * environment_probability(table.first + table.height + cell.y * table.width, cell.x);
    return probability * float(table.width) * float(table.height) / (2.0 * PI * PI * max(sin(PI * (1.0 - uv.y)), 1e-6));
}

// A direction toward the world and its pdf in 1/sr.
vec3 sample_table(DirectionTable table, vec2 u, out float pdf) {
    uint width = table.width, height = table.height;
    uint row = environment_search(table.first, height, u.y);
    float row_probability = environment_probability(table.first, row);
    uint first = table.first + height + row * width;
    uint column = environment_search(first, width, u.x);
    float column_probability = environment_probability(first, column);
    float below_row = row == 0u ? 0.0 : environment_distribution[table.first + row - 1u];
    float below_column = column == 0u ? 0.0 : environment_distribution[first + column - 1u];
    vec2 uv =
        vec2((float(column) + clamp((u.x - below_column) / max(column_probability, 1e-20), 0.0, 1.0)) / float(width),
             (float(row) + clamp((u.y - below_row) / max(row_probability, 1e-20), 0.0, 1.0)) / float(height));
    float sine = max(sin(PI * (1.0 - uv.y)), 1e-6);
    pdf = row_probability * column_probability * float(width) * float(height) / (2.0 * PI * PI * sine);
    return equirectangular_to_direction(uv);
}

// Pdf in 1/sr with which sample_world gives a direction.
float world_pdf(vec3 direction) {
    if (iteration.environment_width == 0u) return 1.0 / (4.0 * PI);
    return table_pdf(world_table(), direction);
}

// Of a table; of an even world's, which is empty, from all around.
vec3 sample_directions(DirectionTable table, vec2 u, out float pdf) {
    if (table.width != 0u) return sample_table(table, u, pdf);
    pdf = 1.0 / (4.0 * PI);
    return sample_sphere(u);
}

vec3 sample_world(vec2 u, out float pdf) { return sample_directions(world_table(), u, pdf); }

#ifdef PORTALS
// What sample_table and sample_world make a direction of.
vec2 table_to_square(DirectionTable table, vec3 direction) {
    vec2 uv = direction_to_equirectangular(direction);
    uvec2 cell = table_cell(table, uv);
    vec2 within = vec2(fract(uv.x) * float(table.width), uv.y * float(table.height)) - vec2(cell);
    uint first = table.first + table.height + cell.y * table.width;
    float below_row = cell.y == 0u ? 0.0 : environment_distribution[table.first + cell.y - 1u];
    float below_column = cell.x == 0u ? 0.0 : environment_distribution[first + cell.x - 1u];
    return vec2(below_column + within.x * environment_probability(first, cell.x),
                below_row + within.y * environment_probability(table.first, cell.y));
}

vec2 world_to_square(vec3 direction) {
    return iteration.environment_width == 0u ? sphere_to_square(direction) : table_to_square(world_table(), direction);
}
#endif
