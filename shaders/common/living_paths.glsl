// SPDX-License-Identifier: GPL-3.0-or-later
// Threads for the paths of a list (rppm_addon/integrator/common/living_paths.py), not for each that ever began.
#include <LivingPathsHeader>
#include "common/invocation.glsl"
readonly buffer LivingPaths {
    LivingPathsHeader living;
    uint living_paths[];
};

const uint NO_PATH = 0xffffffffu;  // more than any count of paths

// Of a path among those of the list; behind its end more.
uint living_place() { return invocation_index(); }

// The number of the path that is this thread's, or NO_PATH behind the list's end.
uint living_path() {
    uint place = invocation_index();
    return place < living.count ? living_paths[place] : NO_PATH;
}
