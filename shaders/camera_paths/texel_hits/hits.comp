#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Texels that are baked become rays, hits and fresh camera paths. As in Cycles, a surface is seen from straight above,
// or from the camera, but never from behind.

layout(local_size_x = 64) in;

#include <TexelParameters>
#include <Texel>
#include "common/iteration.glsl"
#include "common/invocation.glsl"
#include "common/low_discrepancy.glsl"
#include "common/camera_path.glsl"
uniform Parameters { TexelParameters parameters; };
readonly buffer BakedTexels { Texel baked_texels[]; };
readonly buffer Triangles;
readonly buffer Attributes;
#include "common/triangle_normal.glsl"
writeonly buffer Rays;
writeonly buffer Hits;
writeonly buffer CameraPaths;

// The least cosine to the shading normal by which surfaces are seen from a camera: those that turn away from it would
// be black. Cycles' own.
const float LEAST_FACING = 0.2, ABOVE = 1e-5;

// Back from beyond either end.
float mirrored(float x, float end) {
    float turned = mod(abs(x), 2.0 * max(end, 1e-12));
    return turned > end ? 2.0 * end - turned : turned;
}

// The texel's point of this iteration; the first is its middle.
vec2 barycentrics(Texel texel, uint index) {
    vec2 b = vec2(texel.b1, texel.b2);
    if (iteration.number <= 1u) return b;
    uvec4 choices = pcg4d(uvec4(parameters.first_pixel + index, 0u, iteration.seed, STAGE_CAMERA << 24u));
    vec2 at = scrambled_sobol(iteration.number - 1u, choices) - 0.5;
    b += vec2(dot(texel.differentials.xy, at), dot(texel.differentials.zw, at));
    b.x = mirrored(b.x, 1.0);
    b.y = mirrored(b.y, 1.0 - b.x);
    return b;
}

vec3 seen_from(vec3 position, vec3 shading, vec3 geometric) {
    if (parameters.straight_down != 0u) return shading;
    vec3 direction = normalize(parameters.viewer.xyz - parameters.viewer.w * position);
    float facing = dot(direction, shading);
    if (facing <= LEAST_FACING) direction = normalize(direction - shading * (facing - LEAST_FACING));
    if (facing <= 0.0) direction = normalize(mix(direction, shading, -facing));
    float above = dot(direction, geometric);
    return above <= ABOVE ? normalize(direction - geometric * (above - ABOVE)) : direction;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    Texel texel = baked_texels[index];
    bool known = texel.triangle != NO_TRIANGLE;
    uint triangle = known ? texel.triangle : 0u;
    vec2 b = barycentrics(texel, index);
    vec3 v0 = triangle_vertices[3u * triangle].xyz;
    vec3 e1 = triangle_vertices[3u * triangle + 1u].xyz - v0, e2 = triangle_vertices[3u * triangle + 2u].xyz - v0;
    vec3 position = v0 + b.x * e1 + b.y * e2, face = cross(e1, e2);
    if (parameters.see_environment != 0u) {
        rays[index] = Ray(vec3(0.0), NO_TRIANGLE, normalize(position), known ? INFINITY_DISTANCE : 0.0);
        hits[index] = Hit(NO_TRIANGLE, 0.0, 0.0, INFINITY_DISTANCE);
        camera_paths[index] =
            CameraPath(vec3(1.0), 0.0, 0.0, 0.0, 0.0, PATH_CAMERA_TRANSPARENT, 0u, 0u, 0u, 0.0, 0u, 0u, NO_PDF, 1.0);
        return;
    }
    vec3 geometric = face / max(length(face), 1e-30);
    vec3 shading = triangle_normal(triangle, vec3(1.0 - b.x - b.y, b));
    shading = length(shading) > 1e-6 ? normalize(shading) : geometric;
    vec3 above = seen_from(position, shading, geometric);
    // The differentials are those of half a texel. A vertex stands for its part of the triangle.
    vec3 across = texel.differentials.x * e1 + texel.differentials.z * e2;
    vec3 upward = texel.differentials.y * e1 + texel.differentials.w * e2;
    bool is_vertex = texel.differentials == vec4(0.0);
    float area = is_vertex ? length(face) / 6.0 : 4.0 * length(cross(across, upward));
    // On the surface itself: no light lies before it.
    rays[index] = Ray(position, NO_TRIANGLE, -above, known ? INFINITY_DISTANCE : 0.0);
    hits[index] = Hit(texel.triangle, b.x, b.y, 0.0);
    float facing = max(abs(dot(geometric, above)), 1e-4);
    camera_paths[index] = CameraPath(vec3(1.0), 0.0, 0.0, 0.0, sqrt(area * facing / PI), PATH_CAMERA_TRANSPARENT, 0u,
                                     0u, 0u, 0.0, 0u, 0u, NO_PDF, 1.0);
}
