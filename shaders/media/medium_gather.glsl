// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/camera_path.glsl"
#include "common/medium_vertices.glsl"

// Whether the last vertex of a camera path that stores photons is in a medium. Shadow rays from there, and photons that
// have come straight to it, bring the light that its ray would find without another such vertex.
bool is_medium_gather(CameraPath path) {
    return (path.flags & (PATH_FINAL_GATHER | PATH_SECONDARY_GATHER)) == PATH_FINAL_GATHER
           && medium_count(path.bounce_counts) > 0u;
}

// Whether a camera path takes the light that media scatter along its ray. Photons bring that of the rays of final
// gathers to where these began, unless a ray portal lies between.
bool takes_scattered_light(CameraPath path) {
#ifdef RAY_PORTALS
    if ((path.lit_from & BEHIND_RAY_PORTAL) != 0u) return true;
#endif
    return (path.flags & PATH_FINAL_GATHER) == 0u || is_medium_gather(path);
}

// Whether that light comes along the ray of a final gather that began on a surface.
bool scattered_light_is_gathered(CameraPath path) {
    return (path.flags & PATH_FINAL_GATHER) != 0u && !is_medium_gather(path);
}
