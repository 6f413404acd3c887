#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// DIRT's deferred fetch: hits become closures. The only stage that knows materials: a program for each structure of
// node graphs resolves the hits on them.

layout(local_size_x = 64) in;

#include <Ray>
#include <Hit>
#include <Material>
#include <ResolveParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
layout(std140, binding = 0) uniform Parameters { ResolveParameters parameters; };
#include "materials/data.glsl"
#include "materials/surface.glsl"
#include "materials/builder.glsl"
#include "materials/usable.glsl"
#include "common/camera_path.glsl"
#include "resolve/ranges.glsl"

layout(std430, binding = 0) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 1) readonly buffer Hits { Hit hits[]; };
layout(std430, binding = 2) writeonly buffer Closures { Closure closures[]; };
layout(std430, binding = 5) readonly buffer Materials { Material materials[]; };
layout(std430, binding = 13) readonly buffer PathFlags { uint path_words[]; };

const uint NO_PROGRAM = 0xffffffffu;

#include "materials/generated.glsl"

// What the camera path's last event tells; photons see materials as diffuse rays do.
uint ray_kind(uint index) {
    if (parameters.path_stride == 0u) return RAY_DIFFUSE;
    uint flags = path_words[parameters.path_stride * index + parameters.path_flags];
    if ((flags & PATH_STRAIGHT) != 0u) return RAY_CAMERA;
    if ((flags & PATH_DIFFUSE) != 0u) return RAY_DIFFUSE;
    return ((flags & PATH_TRANSMITTED) != 0u ? RAY_TRANSMISSION : RAY_GLOSSY) | ((flags & PATH_SINGULAR) != 0u ? RAY_SINGULAR : 0u);
}

void main() {
    uint index = invocation_index();
    if (parameters.program == NO_PROGRAM) {
        if (index >= parameters.count) return;
        if (!(rays[index].maximum_distance > 0.0) || hits[index].triangle == NO_TRIANGLE) {
            closures[index].triangle = NO_TRIANGLE;  // the rest of it is never read
            return;
        }
    } else {
        if (index >= range_length(parameters.program)) return;
        index = hit_order[range_first(parameters.program) + index];
    }
    Ray ray = rays[index];
    Hit hit = hits[index];
    vec3 v0, v1, v2;
    triangle_points(hit.triangle, v0, v1, v2);
    vec3 b = vec3(1.0 - hit.b1 - hit.b2, hit.b1, hit.b2);
    Surface surface;
    surface.viewer = -ray.direction;
    surface.geometric = normalize(cross(v1 - v0, v2 - v0));
    vec3 shading = triangle_normal(hit.triangle, b);
    float shading_length = length(shading);
    shading = shading_length > 1e-6 ? shading / shading_length : surface.geometric;
    surface.backfacing = dot(surface.geometric, surface.viewer) < 0.0;
    if (surface.backfacing) surface.geometric = -surface.geometric;
    if (dot(shading, surface.geometric) < 0.0) shading = -shading;
    // A shading normal that faces away from the viewer has no meaning: bend it until it is seen.
    float seen = dot(shading, surface.viewer);
    if (seen < 1e-3) shading = normalize(shading + (1e-3 - seen) * surface.viewer);
    surface.normal = shading;
    surface.position = b.x * v0 + b.y * v1 + b.z * v2;
    surface.barycentrics = b;
    surface.triangle = hit.triangle;
    surface.uv = triangle_uv(hit.triangle, b);
    surface.instance = attributes[hit.triangle].instance;
    surface.ray = ray_kind(index);
    surface.ray_length = hit.distance;
    surface.ray_depth = parameters.segment + (parameters.path_stride == 0u ? 1u : 0u);

    RandomSequence random = random_sequence(parameters.seed, parameters.iteration, STAGE_RESOLVE, parameters.segment, index);
    ClosureBuilder builder = closure_builder(surface.viewer, surface.geometric, shading, surface.backfacing, next_random(random));
    uint material = attributes[hit.triangle].material;
    builder.closure.position = surface.position;
    builder.closure.triangle = hit.triangle;
    builder.closure.flags = surface.backfacing ? CLOSURE_BACKFACING : 0u;
    builder.closure.material = material;
    builder.closure.distance = hit.distance;
    builder.closure.geometric_normal = pack_unit_vector(surface.geometric);
    builder.closure.shading_normal = pack_unit_vector(shading);
    evaluate_material(surface, materials[material].first_constant, builder);
    make_usable(builder.closure);
    closures[index] = builder.closure;
}
