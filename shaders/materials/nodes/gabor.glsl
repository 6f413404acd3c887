// SPDX-License-Identifier: GPL-3.0-or-later
// Gabor noise (Lagae et al. 2009) with a fixed number of impulses of random sign in each cell (Tavernier et al.
// 2019) and, of its complex sum, phase and intensity (Tricard et al. 2019).
#include "common/constants.glsl"
#include "materials/nodes/hash.glsl"

const int GABOR_IMPULSES = 8;

// In two dimensions z of the cells is zero and the hashes have a component less.
float gabor_hash(int dimensions, vec3 cell, float seed) {
    return dimensions == 2 ? hash_to_unit(vec3(cell.xy, seed)) : hash_to_unit(vec4(cell, seed));
}

vec3 gabor_center(int dimensions, vec3 cell, float seed) {
    vec3 key = vec3(cell.xy, seed);
    return dimensions == 2 ? vec3(hash_to_unit(key), hash_to_unit(key.zxy), 0.0) : hash_to_color(vec4(cell, seed));
}

// Unit vector along the waves of an impulse. angles: of the base direction, in radians; turn: 0 keeps that.
vec3 gabor_direction(int dimensions, vec3 base, vec2 angles, float turn, vec3 cell, float seed) {
    if (dimensions == 2) {
        float angle = angles.x + (gabor_hash(2, cell, seed) - 0.5) * PI * turn;
        return vec3(cos(angle), sin(angle), 0.0);
    }
    vec4 key = vec4(cell, seed);
    vec2 turned = angles + PI * turn * vec2(hash_to_unit(key), hash_to_unit(key.zxwy));
    vec3 direction = vec3(sin(turned.x) * vec2(cos(turned.y), sin(turned.y)), cos(turned.x));
    return turn == 0.0 ? base : direction;
}

void node_tex_gabor(int gabor_type, vec3 vector, float scale, float frequency, float anisotropy, float orientation_2d,
                    vec3 orientation_3d, out float value, out float phase, out float intensity) {
    int dimensions = gabor_type + 2;
    int cells = dimensions == 2 ? 9 : 27;
    vec3 p = vector * scale;
    if (dimensions == 2) p.z = 0.0;
    vec3 corner = floor(p);
    frequency = max(frequency, 0.001);
    float turn = 1.0 - clamp(anisotropy, 0.0, 1.0);
    vec3 base = vec3(0.0);
    vec2 angles = vec2(orientation_2d, 0.0);
    if (dimensions == 3) {
        base = dot(orientation_3d, orientation_3d) > 0.0 ? normalize(orientation_3d) : orientation_3d;
        float across = length(base.xy);
        angles = vec2(atan(across, base.z), across > 0.0 ? atan(base.y, base.x) : 0.0);
    }

    vec2 sum = vec2(0.0);
    for (int index = 0; index < cells; ++index) {
        uint i = uint(index);
        vec3 offset = vec3(i % 3u, i / 3u % 3u, i / 9u) - 1.0;
        if (dimensions == 2) offset.z = 0.0;
        vec3 cell = corner + offset;
        for (int impulse = 0; impulse < GABOR_IMPULSES; ++impulse) {
            float seed = float(3 * impulse);
            vec3 way = p - corner - offset - gabor_center(dimensions, cell, seed + 1.0);
            float squared = dot(way, way);
            vec3 direction = gabor_direction(dimensions, base, angles, turn, cell, seed);
            float angle = 2.0 * PI * dot(way, frequency * direction);
            float window = exp(-PI * squared) * (0.5 + 0.5 * cos(PI * squared));
            float sign_of_impulse = gabor_hash(dimensions, cell, seed + 2.0) < 0.5 ? -1.0 : 1.0;
            if (squared < 1.0) sum += sign_of_impulse * window * vec2(cos(angle), sin(angle));
        }
    }
    // Six standard deviations, as if the Gaussian had no window: Lagae et al., equation 9, at high frequency.
    float energy = dimensions == 2 ? 0.25 : 0.25 / sqrt(2.0);
    float range = 6.0 * sqrt(float(GABOR_IMPULSES) * 0.5 * energy);
    value = 0.5 + 0.5 * sum.y / range;
    phase = sum == vec2(0.0) ? 0.5 : (atan(sum.y, sum.x) + PI) / (2.0 * PI);
    intensity = length(sum) / range;
}
