// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/camera_path.glsl"

// Whether a camera path has come straight from the camera, so that its ray is that of its pixel.
bool is_straight(uint flags) { return (flags & PATH_CAMERA_TRANSPARENT) != 0u && (flags & PATH_FINAL_GATHER) == 0u; }
