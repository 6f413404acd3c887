// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/camera_path.glsl"

// Whether a camera path has come straight from the camera, so that its ray is that of its pixel.
bool is_straight(CameraPath path) {
#ifdef RAY_PORTALS
    if (path.lit_from >= ONE_RAY_PORTAL) return false;
#endif
    return (path.flags & PATH_CAMERA_TRANSPARENT) != 0u && (path.flags & PATH_FINAL_GATHER) == 0u;
}
