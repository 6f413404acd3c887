// SPDX-License-Identifier: GPL-3.0-or-later
// What the search for media asks of hits on instances, whose attributes are not gathered: a kernel that looks at hits
// itself only gives them no numbers.

readonly buffer SlotMaterials;

uint instance_of(uint triangle) {
    uvec2 origin;
    if (!find_origin(triangle, origin)) return attributes[triangle].instance;
    return bottom_level_instances[origin.x].placement;
}

uint material_of(uint triangle) {
    uvec2 origin;
    if (!find_origin(triangle, origin)) return attributes[triangle].material;
    BottomLevelInstance instance = bottom_level_instances[origin.x];
    uint slot = uint(world_vertex(3u * (instance.first_triangle + origin.y)).w);
    return slot_materials[instance.first_slot + min(slot, instance.slot_count - 1u)];
}
