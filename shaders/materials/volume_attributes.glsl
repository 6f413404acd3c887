// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes of a volume, which are grids of voxels (rppm_addon/materials/media/volume_attributes.py), in place of
// those of meshes in materials/surface.glsl. The includer defines VOLUME_ATTRIBUTES and includes that file before.

#include "materials/volume_grids.glsl"

// A grid's place and its components; none: 0.
uvec2 attribute_place(Surface surface, uint layer) {
    return uvec2(volume_grids[layer].first_value, volume_grids[layer].components);
}

vec4 attribute_value(Surface surface, uint layer) {
    return volume_grid_value(volume_grids[layer], point_to_object(surface, surface.position));
}
