// SPDX-License-Identifier: GPL-3.0-or-later
// Image and environment textures.

#include "materials/textures.glsl"

#include <ImageProjections>

vec2 sphere_to_uv(vec3 p) {
    float size = length(p);
    if (size <= 0.0) return vec2(0.0);
    float u = p.x == 0.0 && p.y == 0.0 ? 0.0 : (1.0 - atan(p.x, p.y) / PI) * 0.5;
    return vec2(u, 1.0 - acos(clamp(p.z / size, -1.0, 1.0)) / PI);
}

vec2 tube_to_uv(vec3 p) {
    float size = length(p.xy);
    return size > 0.0 ? vec2((1.0 - atan(p.x / size, p.y / size) / PI) * 0.5, (p.z + 1.0) * 0.5) : vec2(0.0);
}

// Shares of the three projections by the normal: one alone, two around an edge, three in a corner.
vec3 box_weights(vec3 n, float blend) {
    n = abs(n);
    n /= max(n.x + n.y + n.z, 1e-20);
    float limit = 0.5 * (1.0 + blend), steep = 1.0 - limit;
    if (n.x > limit * (n.x + n.y) && n.x > limit * (n.x + n.z)) return vec3(1.0, 0.0, 0.0);
    if (n.y > limit * (n.x + n.y) && n.y > limit * (n.y + n.z)) return vec3(0.0, 1.0, 0.0);
    if (n.z > limit * (n.x + n.z) && n.z > limit * (n.y + n.z)) return vec3(0.0, 0.0, 1.0);
    if (blend <= 0.0) return vec3(1.0, 0.0, 0.0);
    vec3 w = vec3(0.0);
    if (n.z < steep * (n.y + n.x)) {
        w.x = clamp((n.x / (n.x + n.y) - 0.5 * (1.0 - blend)) / blend, 0.0, 1.0);
        w.y = 1.0 - w.x;
    } else if (n.x < steep * (n.y + n.z)) {
        w.y = clamp((n.y / (n.y + n.z) - 0.5 * (1.0 - blend)) / blend, 0.0, 1.0);
        w.z = 1.0 - w.y;
    } else if (n.y < steep * (n.x + n.z)) {
        w.x = clamp((n.x / (n.x + n.z) - 0.5 * (1.0 - blend)) / blend, 0.0, 1.0);
        w.z = 1.0 - w.x;
    } else w = ((2.0 - limit) * n + (limit - 1.0)) / (2.0 * limit - 1.0);
    return w;
}

void node_tex_image(Surface surface, int projection, int interpolation, int extension, int divide, uint image,
                    vec3 vector, float projection_blend, out vec3 color, out float alpha) {
    bool box = projection == IMAGE_BOX;
    vec3 n = vec3(0.0), weights = vec3(1.0, 0.0, 0.0);
    if (box) {
        n = normal_to_object(surface, surface.normal);
        n /= max(length(n), 1e-20);
        weights = box_weights(n, projection_blend);
    }
    vec4 found = vec4(0.0);
    for (int axis = 0; axis < (box ? 3 : 1); ++axis) {
        vec2 at = vector.xy;
        if (box)
            at = axis == 0   ? vec2(n.x < 0.0 ? 1.0 - vector.y : vector.y, vector.z)
                 : axis == 1 ? vec2(n.y > 0.0 ? 1.0 - vector.x : vector.x, vector.z)
                             : vec2(n.z > 0.0 ? 1.0 - vector.y : vector.y, vector.x);
        else if (projection == IMAGE_SPHERE) at = sphere_to_uv(vector - 0.5);
        else if (projection == IMAGE_TUBE) at = tube_to_uv(2.0 * vector - 1.0);
        found += weights[axis] * sample_image(image, at, interpolation, extension, divide);
    }
    color = found.rgb;
    alpha = found.a;
}

// Tiles of 1 x 1 in UV space: the table lists the number of each tile's image, row by row of ten, -1 where none is.
void node_tex_image_tiles(int interpolation, int extension, int divide, uint table, float tiles, vec3 vector,
                          out vec3 color, out float alpha) {
    vec2 corner = floor(vector.xy);
    int tile = int(corner.x) + 10 * int(corner.y);
    color = vec3(1.0, 0.0, 1.0);
    alpha = 1.0;
    if (any(lessThan(corner, vec2(0.0))) || corner.x > 9.0 || tile < 0 || tile >= int(tiles)) return;
    float image = material_data[table + uint(tile)];
    if (image < 0.0) return;
    vec4 found = sample_image(uint(image), vector.xy - corner, interpolation, extension, divide);
    color = found.rgb;
    alpha = found.a;
}

void node_tex_environment(int projection, int interpolation, uint image, vec3 vector, out vec3 color) {
    vec3 d = vector / max(length(vector), 1e-20);
    vec2 at;
    if (projection == ENVIRONMENT_EQUIRECTANGULAR)
        at = vec2(-atan(d.y, d.x) / (2.0 * PI) + 0.5, atan(d.z, length(d.xy)) / PI + 0.5);
    else if (projection == ENVIRONMENT_SKY)
        // Of a vector of any length z alone says how high it points, as in Cycles. The outermost of the 256 rows
        // (sky_picture) are not mixed with those of the other pole.
        at = vec2(-atan(d.y, d.x) / (2.0 * PI) + 0.5,
                  clamp(asin(clamp(vector.z, -1.0, 1.0)) / PI + 0.5, 1.0 / 512.0, 511.0 / 512.0));
    else {
        d.y -= 1.0;
        float divided = 2.0 * sqrt(max(-0.5 * d.y, 0.0));
        if (divided > 0.0) d /= divided;
        at = 0.5 * (d.xz + 1.0);
    }
    color = sample_image(image, at, interpolation, EXTENSION_REPEAT, 0).rgb;
}
