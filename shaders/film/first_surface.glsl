// SPDX-License-Identifier: GPL-3.0-or-later
// Which surface of a camera path the passes are of: as in Cycles the first that does not let more than half of the
// light straight through.

const float MOSTLY_TRANSPARENT = 0.5;

bool is_passed_by(Closure closure) {
    vec3 transparent = closure.transparent;
    return closure_hit(closure) && (transparent.r + transparent.g + transparent.b) / 3.0 > MOSTLY_TRANSPARENT;
}

// Whether a path still looks for it.
bool looks_for_surface(uint flags) {
    return (flags & (PATH_CAMERA_TRANSPARENT | PATH_SURFACE_FOUND)) == PATH_CAMERA_TRANSPARENT;
}
