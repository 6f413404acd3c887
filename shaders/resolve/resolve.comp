#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// DIRT's deferred fetch: hits become closures. The only stage that knows materials.

layout(local_size_x = 64) in;

#include <Ray>
#include <Hit>
#include <TriangleAttributes>
#include <ResolveParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
#include "materials/closures.glsl"

layout(std140, binding = 0) uniform Parameters { ResolveParameters parameters; };
layout(std430, binding = 0) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 1) readonly buffer Hits { Hit hits[]; };
layout(std430, binding = 2) writeonly buffer Closures { Closure closures[]; };
layout(std430, binding = 3) readonly buffer Triangles { vec4 triangle_vertices[]; };
layout(std430, binding = 4) readonly buffer Attributes { TriangleAttributes attributes[]; };

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    Ray ray = rays[index];
    Hit hit = hits[index];
    if (!(ray.maximum_distance > 0.0) || hit.triangle == NO_TRIANGLE) {
        closures[index].triangle = NO_TRIANGLE;  // the rest of it is never read
        return;
    }
    vec3 v0 = triangle_vertices[3u * hit.triangle].xyz;
    vec3 v1 = triangle_vertices[3u * hit.triangle + 1u].xyz;
    vec3 v2 = triangle_vertices[3u * hit.triangle + 2u].xyz;
    TriangleAttributes corners = attributes[hit.triangle];
    vec3 b = vec3(1.0 - hit.b1 - hit.b2, hit.b1, hit.b2);
    vec3 viewer = -ray.direction;
    vec3 geometric = normalize(cross(v1 - v0, v2 - v0));
    vec3 shading = b.x * unpack_unit_vector(corners.normal0) + b.y * unpack_unit_vector(corners.normal1)
                 + b.z * unpack_unit_vector(corners.normal2);
    float shading_length = length(shading);
    shading = shading_length > 1e-6 ? shading / shading_length : geometric;
    bool backfacing = dot(geometric, viewer) < 0.0;
    if (backfacing) geometric = -geometric;
    if (dot(shading, geometric) < 0.0) shading = -shading;
    // A shading normal that faces away from the viewer has no meaning: bend it until it is seen.
    float seen = dot(shading, viewer);
    if (seen < 1e-3) shading = normalize(shading + (1e-3 - seen) * viewer);

    RandomSequence random = random_sequence(parameters.seed, parameters.iteration, STAGE_RESOLVE, parameters.segment, index);
    ClosureBuilder builder = closure_builder(viewer, geometric, shading, backfacing, next_random(random));
    builder.closure.position = b.x * v0 + b.y * v1 + b.z * v2;
    builder.closure.triangle = hit.triangle;
    builder.closure.flags = backfacing ? CLOSURE_BACKFACING : 0u;
    builder.closure.material = corners.material;
    builder.closure.distance = hit.distance;
    builder.closure.geometric_normal = pack_unit_vector(geometric);
    builder.closure.shading_normal = pack_unit_vector(shading);
    vec2 uv = b.x * corners.uv0 + b.y * corners.uv1 + b.z * corners.uv2;
    Material material = materials[corners.material];
    for (uint lobe = 0u; lobe < material.lobe_count; ++lobe)
        add_material_lobe(builder, material_lobes[material.first_lobe + lobe], uv);
    closures[index] = builder.closure;
}
