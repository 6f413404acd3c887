// SPDX-License-Identifier: GPL-3.0-or-later
// Perlin's improved gradient noise (2002) in one to four dimensions, with the gradients of Cycles and OSL.
#include "materials/nodes/hash.glsl"

const float PERLIN_PERIOD = 100000.0;

// Dot product of the gradient that a hash chooses and the way from its corner.
float perlin_gradient(int dimensions, uint hash, vec4 way) {
    float u, v;
    float s = 0.0;
    if (dimensions == 1) {
        u = float(1u + (hash & 7u)) * way.x;
        return (hash & 8u) != 0u ? -u : u;
    } else if (dimensions == 2) {
        bool low = (hash & 7u) < 4u;
        u = low ? way.x : way.y;
        v = 2.0 * (low ? way.y : way.x);
    } else if (dimensions == 3) {
        uint h = hash & 15u;
        u = h < 8u ? way.x : way.y;
        v = h < 4u ? way.y : (h == 12u || h == 14u ? way.x : way.z);
    } else {
        uint h = hash & 31u;
        u = h < 24u ? way.x : way.y;
        v = h < 16u ? way.y : way.z;
        s = h < 8u ? way.z : way.w;
    }
    return ((hash & 1u) != 0u ? -u : u) + ((hash & 2u) != 0u ? -v : v) + ((hash & 4u) != 0u ? -s : s);
}

// Remainder with the sign of p, exact below 5e8. As Cycles, half a cell is added from 1e6 on, where floats get so
// coarse that most would be lattice points, at which noise is zero.
vec4 perlin_wrapped(vec4 p) {
    vec4 size = abs(p);
    vec4 rest = size - PERLIN_PERIOD * floor(size / PERLIN_PERIOD);
    rest += PERLIN_PERIOD * (vec4(lessThan(rest, vec4(0.0))) - vec4(greaterThanEqual(rest, vec4(PERLIN_PERIOD))));
    return rest * sign(p) + 0.5 * vec4(greaterThanEqual(size, vec4(10.0 * PERLIN_PERIOD)));
}

// About in [-1, 1]; the components of p past the dimensions (a literal) do not matter.
float signed_noise(int dimensions, vec4 p) {
    p = perlin_wrapped(p);
    vec4 cell = floor(p);
    vec4 near = p - cell;
    vec4 fade = near * near * near * (near * (near * 6.0 - 15.0) + 10.0);
    uvec4 key = uvec4(ivec4(cell));
    float sum = 0.0;
    for (uint corner = 0u; corner < (1u << dimensions); ++corner) {
        uvec4 side = uvec4(corner, corner >> 1u, corner >> 2u, corner >> 3u) & 1u;
        vec4 far = vec4(side);
        vec4 weights = 1.0 - fade + far * (2.0 * fade - 1.0);
        float weight = weights.x;
        if (dimensions > 1) weight *= weights.y;
        if (dimensions > 2) weight *= weights.z;
        if (dimensions > 3) weight *= weights.w;
        sum += weight * perlin_gradient(dimensions, hash_words(dimensions, key + side), near - far);
    }
    float scale = dimensions == 1 ? 0.25 : dimensions == 2 ? 0.6616 : dimensions == 3 ? 0.982 : 0.8344;
    return scale * sum;
}
