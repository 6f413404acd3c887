// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes of a volume, which are grids of voxels (rppm_addon/materials/media/volume_attributes.py), in place of
// those of meshes in materials/surface.glsl. The includer defines VOLUME_ATTRIBUTES and includes that file before.

#include <VolumeGridEntry>
readonly buffer VolumeGrids { VolumeGridEntry volume_grids[]; };
readonly buffer VolumeValues { float volume_values[]; };

// A grid's place and its components; none: 0.
uvec2 attribute_place(Surface surface, uint layer) {
    return uvec2(volume_grids[layer].first_value, volume_grids[layer].components);
}

vec4 volume_value(VolumeGridEntry grid, ivec3 cell) {
    vec4 value = vec4(0.0, 0.0, 0.0, 1.0);
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(grid.voxels)))) return vec4(0.0);
    uvec3 voxel = uvec3(cell);
    uint at = grid.first_value + ((voxel.x * grid.voxels.y + voxel.y) * grid.voxels.z + voxel.z) * grid.components;
    for (uint k = 0u; k < min(grid.components, 4u); ++k) value[k] = volume_values[at + k];
    if (grid.components == 1u) value.yz = value.xx;
    return value;
}

// Trilinear interpolation between the centers of voxels.
vec4 attribute_value(Surface surface, uint layer) {
    VolumeGridEntry grid = volume_grids[layer];
    if (grid.components == 0u) return vec4(0.0);
    vec4 place = vec4(point_to_object(surface, surface.position), 1.0);
    vec3 at = vec3(dot(grid.to_grid0, place), dot(grid.to_grid1, place), dot(grid.to_grid2, place));
    vec3 first = floor(at), f = at - first;
    vec4 sum = vec4(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 offset = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 weights = mix(1.0 - f, f, vec3(offset));
        sum += weights.x * weights.y * weights.z * volume_value(grid, ivec3(first) + offset);
    }
    return sum;
}
