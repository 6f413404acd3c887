// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/camera_path.glsl"
#include "common/medium_vertices.glsl"

// Whether the last vertex of a camera path that stores photons is in a medium. Shadow rays from there, and photons that
// have come straight to it, bring the light that its ray would find without another such vertex.
bool is_medium_gather(CameraPath path) {
    return (path.flags & (PATH_FINAL_GATHER | PATH_SECONDARY_GATHER)) == PATH_FINAL_GATHER
           && medium_count(path.bounce_counts) > 0u;
}
