// SPDX-License-Identifier: GPL-3.0-or-later
// Grids of voxels in the space of an object (rppm_addon/materials/media/volume_attributes.py).

#include <VolumeGridEntry>
readonly buffer VolumeGrids { VolumeGridEntry volume_grids[]; };
readonly buffer VolumeValues { float volume_values[]; };

vec4 volume_value(VolumeGridEntry grid, ivec3 cell) {
    vec4 value = vec4(0.0, 0.0, 0.0, 1.0);
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(grid.voxels)))) return vec4(0.0);
    uvec3 voxel = uvec3(cell);
    uint at = grid.first_value + ((voxel.x * grid.voxels.y + voxel.y) * grid.voxels.z + voxel.z) * grid.components;
    for (uint k = 0u; k < min(grid.components, 4u); ++k) value[k] = volume_values[at + k];
    if (grid.components == 1u) value.yz = value.xx;
    return value;
}

// Trilinear interpolation between the centers of voxels, at a point of the object.
vec4 volume_grid_value(VolumeGridEntry grid, vec3 point) {
    if (grid.components == 0u) return vec4(0.0);
    vec4 place = vec4(point, 1.0);
    vec3 at = vec3(dot(grid.to_grid0, place), dot(grid.to_grid1, place), dot(grid.to_grid2, place));
    at = clamp(at, vec3(-1.0), vec3(grid.voxels));  // beyond are zeros
    vec3 first = floor(at), f = at - first;
    vec4 sum = vec4(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 offset = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 weights = mix(1.0 - f, f, vec3(offset));
        sum += weights.x * weights.y * weights.z * volume_value(grid, ivec3(first) + offset);
    }
    return sum;
}
