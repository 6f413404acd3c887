// SPDX-License-Identifier: GPL-3.0-or-later
// What the search for media asks of hits on instances.
#include "acceleration/hits/two_levels.glsl"

readonly buffer SlotMaterials;

uint material_of(uint triangle) {
    uvec2 origin;
    if (!find_origin(triangle, origin)) return attributes[triangle].material;
    BottomLevelInstance instance = bottom_level_instances[origin.x];
    uint slot = uint(world_vertex(3u * (instance.first_triangle + origin.y)).w);
    return slot_materials[instance.first_slot + min(slot, instance.slot_count - 1u)];
}
