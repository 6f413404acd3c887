// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/camera_path.glsl"

// The kinds of rays that Cycles distinguishes. Photons count as rays that a diffuse surface sends out.
#include <RayVisibility>
const uint RAYS_WITH_VISIBILITY = RAY_CAMERA | RAY_DIFFUSE | RAY_GLOSSY | RAY_TRANSMISSION | RAY_VOLUME_SCATTER;
const uint RAY_SINGULAR = 64u;  // with one of these: it has but one direction

// What the last event of a camera path made of its ray.
uint camera_ray_kind(uint flags) {
    if ((flags & PATH_CAMERA_TRANSPARENT) != 0u) return RAY_CAMERA;
    if ((flags & PATH_DIFFUSE) != 0u) return (flags & PATH_SINGULAR) != 0u ? RAY_VOLUME_SCATTER : RAY_DIFFUSE;
    return ((flags & PATH_TRANSMITTED) != 0u ? RAY_TRANSMISSION : RAY_GLOSSY)
           | ((flags & PATH_SINGULAR) != 0u ? RAY_SINGULAR : 0u);
}
