// SPDX-License-Identifier: GPL-3.0-or-later
// Where paths come straight through surfaces. The includer includes before common/bsdf/closure.glsl.
#include "common/path_depth.glsl"

// What is hidden from a path, or catches shadows for it, is not there, and no limit counts it.
bool counts_as_transparent(Closure closure) {
    return (closure.flags & (CLOSURE_ABSENT | CLOSURE_CATCHES_SHADOWS)) == 0u;
}

// depth: of the path that came to the surface; most: transparent surfaces that it may pass.
bool may_pass(Closure closure, uint depth, uint most) {
    return transparents_of(depth) < most || !counts_as_transparent(closure);
}
