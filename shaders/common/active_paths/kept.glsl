// SPDX-License-Identifier: GPL-3.0-or-later
// A list of paths that grows, with the arguments of a dispatch over it; it begins empty.
buffer KeptPaths;

#include <Dispatch>

void keep_path(uint path) {
    uint place = atomicAdd(kept.count, 1u);
    kept_paths[place] = path;
    if (place % GROUP_SIZE != 0u) return;
    uint group = place / GROUP_SIZE;
    if (group < GROUPS_PER_ROW) atomicAdd(kept.groups.x, 1u);
    if (group % GROUPS_PER_ROW == 0u) atomicAdd(kept.groups.y, 1u);
}
