// SPDX-License-Identifier: GPL-3.0-or-later
// The last vertex of a camera path, behind its last bounce: it only sees emission there, and passes transparent
// surfaces.
#include "common/iteration.glsl"
#include "common/camera_path.glsl"
#include "common/path_depth.glsl"
#ifdef COUNTS_BOUNCES
#include "common/bounce_limits.glsl"
#endif

bool is_last_vertex(CameraPath path) {
#ifdef COUNTS_BOUNCES
    if (exceed_limits(counts_of(path.bounce_counts))) return true;
#endif
    return bounces_of(path.depth) > iteration.camera_bounces;
}
