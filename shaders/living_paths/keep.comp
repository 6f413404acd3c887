#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Of the paths of a list, those whose rays are to be traced, as a list.

layout(local_size_x = 64) in;

#include <Ray>
#include "common/living_paths.glsl"
layout(std430, binding = 0) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 1) buffer KeptPaths { LivingPathsHeader kept; uint kept_paths[]; };

const uint GROUP_SIZE = 64u, GROUPS_PER_ROW = 65535u;

void main() {
    uint path = living_path();
    if (path == NO_PATH || !(rays[path].maximum_distance > 0.0)) return;
    uint place = atomicAdd(kept.count, 1u);
    kept_paths[place] = path;
    if (place % GROUP_SIZE != 0u) return;
    uint group = place / GROUP_SIZE;
    if (group < GROUPS_PER_ROW) atomicAdd(kept.groups.x, 1u);
    if (group % GROUPS_PER_ROW == 0u) atomicAdd(kept.groups.y, 1u);
}
