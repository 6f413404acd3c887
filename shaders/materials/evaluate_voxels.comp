#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The emission of a node graph at the centers of voxels, brick by brick: a coefficient of a medium that varies.

layout(local_size_x = 64) in;

// Nodes read the grids of a volume.
#define VOLUME_ATTRIBUTES

#include <EvaluateVoxelsParameters>
#include "common/invocation.glsl"
uniform Parameters { EvaluateVoxelsParameters parameters; };
#include <VoxelBricks>
#include "materials/data.glsl"
#include "materials/surface.glsl"
#include "materials/volume_attributes.glsl"
#include "materials/builder.glsl"
writeonly buffer Emissions;

#include "materials/generated.glsl"

uvec3 voxel_at(uint index) {
    uvec3 bricks = (parameters.voxels + (BRICK_SIDE - 1u)) / BRICK_SIDE;
    uint brick = parameters.first_brick + index / BRICK_VOXELS, local = index % BRICK_VOXELS;
    uvec3 first = uvec3(brick % bricks.x, brick / bricks.x % bricks.y, brick / (bricks.x * bricks.y));
    return BRICK_SIDE * first
           + uvec3(local % BRICK_SIDE, local / BRICK_SIDE % BRICK_SIDE, local / (BRICK_SIDE * BRICK_SIDE));
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uvec3 voxel = voxel_at(index);
    emissions[index] = vec4(0.0);
    if (any(greaterThanEqual(voxel, parameters.voxels))) return;
    vec4 center = vec4(vec3(voxel), 1.0);
    vec3 position =
        vec3(dot(parameters.to_world0, center), dot(parameters.to_world1, center), dot(parameters.to_world2, center));
    const vec3 UP = vec3(0.0, 0.0, 1.0);
    Surface surface = Surface(position, UP, UP, UP, vec2(0.0), vec3(0.0), vec3(0.0), NO_TRIANGLE, parameters.instance,
                              false, RAY_DIFFUSE, 0.0, 0u, 0u, 0u, 0u);
    ClosureBuilder builder = closure_builder(UP, UP, UP, false, 0.0);
    evaluate_material(surface, parameters.first_constant, builder);
    emissions[index] = vec4(builder.closure.emission, 0.0);
}
