#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The voxels of a grid at a moment while the shutter is open: each has the values at the place that it comes from along
// the velocities of its volume (rppm_addon/materials/media/advection.py). One thread writes two voxels of a brick.

layout(local_size_x = 64) in;

#include <AdvectVoxelsParameters>
#include "common/half.glsl"
#include "common/invocation.glsl"
uniform Parameters { AdvectVoxelsParameters parameters; };
#include <VoxelBricks>
#include "materials/volume_grids.glsl"
readonly buffer RestingVoxels { uint resting_voxels[]; };
readonly buffer MovingBricks { uint moving_bricks[]; };
writeonly buffer MovedVoxels { uint moved_voxels[]; };

const uint WORDS = BRICK_VOXELS / 2u;

uvec3 brick_counts() { return (parameters.voxels + (BRICK_SIDE - 1u)) / BRICK_SIDE; }

float resting_value(uint channel, ivec3 cell) {
    uvec3 voxel = uvec3(clamp(cell, ivec3(0), ivec3(parameters.voxels) - 1));
    uvec3 brick = voxel / BRICK_SIDE, local = voxel % BRICK_SIDE, bricks = brick_counts();
    uint place = resting_voxels[parameters.first_resting + brick.x + bricks.x * (brick.y + bricks.y * brick.z)];
    if (place == 0u) return 0.0;
    uint number = channel * BRICK_VOXELS + local.x + BRICK_SIDE * (local.y + BRICK_SIDE * local.z);
    uint word = resting_voxels[place + number / 2u];
    return half_to_float((number & 1u) == 0u ? word & 0xffffu : word >> 16u);
}

// Trilinear interpolation between the centers of voxels.
float resting_value(uint channel, vec3 at) {
    vec3 first = floor(at), f = at - first;
    float sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 offset = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 weights = mix(1.0 - f, f, vec3(offset));
        float weight = weights.x * weights.y * weights.z;
        if (weight > 0.0) sum += weight * resting_value(channel, ivec3(first) + offset);
    }
    return sum;
}

// Where the values of a voxel come from, voxels.
vec3 source_of(uvec3 voxel) {
    vec3 place = parameters.low + vec3(voxel) * parameters.spacing, source = place;
    for (int k = 0; k < 2; ++k) {
        vec3 displacement = volume_grid_value(volume_grids[parameters.volume], source).xyz;
        source = place - parameters.time * displacement;
        if (displacement == vec3(0.0)) break;
    }
    return clamp((source - parameters.low) / parameters.spacing, vec3(0.0), vec3(parameters.voxels) - 1.0);
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    uint brick = moving_bricks[parameters.first_brick + index / WORDS], word = index % WORDS;
    uvec3 bricks = brick_counts();
    uvec3 first = BRICK_SIDE * uvec3(brick % bricks.x, brick / bricks.x % bricks.y, brick / (bricks.x * bricks.y));
    uint local = 2u * word;
    first += uvec3(local % BRICK_SIDE, local / BRICK_SIDE % BRICK_SIDE, local / (BRICK_SIDE * BRICK_SIDE));
    vec3 low = source_of(first), high = source_of(first + uvec3(1u, 0u, 0u));
    uint place = parameters.first_moved + (index / WORDS) * parameters.channels * WORDS + word;
    for (uint channel = 0u; channel < parameters.channels; ++channel) {
        uint halves = float_to_half(resting_value(channel, low)) | float_to_half(resting_value(channel, high)) << 16u;
        moved_voxels[place + channel * WORDS] = halves;
    }
}
