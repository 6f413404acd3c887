// SPDX-License-Identifier: GPL-3.0-or-later
// Where paths come straight through surfaces. The includer includes before common/bsdf/closure.glsl.
#include "common/path_depth.glsl"

// Length of a ray that goes on and meets no surface.
const float ESCAPING_DISTANCE = 1e-30;

// What is hidden from a path, or catches shadows for it, is not there, and no limit counts it.
bool counts_as_transparent(Closure closure) {
    return (closure.flags & (CLOSURE_ABSENT | CLOSURE_CATCHES_SHADOWS)) == 0u;
}

// Whether a path of this depth may pass the transparent part of a closure, as far as the limit of transparent surfaces.
bool may_pass(Closure closure, uint depth, uint limit) {
    return transparents_of(depth) < limit || !counts_as_transparent(closure);
}

// Takes out of a closure what a path of this depth may not pass straight, or by a ray portal.
void limit_transparency(inout Closure closure, uint depth, uint limit) {
    if (may_pass(closure, depth, limit)) return;
    closure.transparent = vec3(0.0);
#ifdef RAY_PORTALS
    closure.flags |= CLOSURE_KEEPS_LIGHT;
#endif
}

// Whether a path that passes through a surface comes into or out of its medium. It leaves that of a hidden object too.
bool may_cross(Closure closure) { return (closure.flags & CLOSURE_UNSEEN) == 0u || closure_backfacing(closure); }
