// SPDX-License-Identifier: GPL-3.0-or-later
// Threads for the paths of a list (rppm_addon/integrator/common/active_paths.py), not for each that ever began.
#include <ActivePathsHeader>
#include "common/invocation.glsl"
readonly buffer ActivePaths {
    ActivePathsHeader active_header;
    uint active_paths[];
};

const uint NO_PATH = 0xffffffffu;  // more than any count of paths

// Of a path among those of the list; behind its end more.
uint active_place() { return invocation_index(); }

// The number of the path that is this thread's, or NO_PATH behind the list's end.
uint active_path() {
    uint place = invocation_index();
    return place < active_header.count ? active_paths[place] : NO_PATH;
}
