// SPDX-License-Identifier: GPL-3.0-or-later
// The first surface of a camera path, which the passes show. As in Cycles, surfaces whose alpha is below the Alpha
// Threshold of the view layer are skipped.

#include "common/bsdf/ray_portal.glsl"

bool is_skipped(Closure closure) {
    vec3 transparent = seen_beyond(closure);
    return closure_hit(closure) && (transparent.r + transparent.g + transparent.b) / 3.0 > iteration.most_transparent;
}

// Whether a path still needs_surface for it.
bool needs_first_surface(uint flags) {
    return (flags & (PATH_CAMERA_TRANSPARENT | PATH_SURFACE_FOUND)) == PATH_CAMERA_TRANSPARENT;
}
