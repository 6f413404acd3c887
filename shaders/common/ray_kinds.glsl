// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/camera_path.glsl"

// The rays that Cycles tells apart; the first four are also bits of scene.RayVisibility. Photons count as rays that a
// diffuse surface sends out.
const uint RAY_CAMERA = 1u, RAY_DIFFUSE = 2u, RAY_GLOSSY = 4u, RAY_TRANSMISSION = 8u, RAY_SINGULAR = 16u;
const uint RAYS_WITH_VISIBILITY = 15u, VISIBLE_TO_SHADOW_RAYS = 16u;

// What the last event of a camera path made of its ray.
uint camera_ray_kind(uint flags) {
    if ((flags & PATH_STRAIGHT) != 0u) return RAY_CAMERA;
    if ((flags & PATH_DIFFUSE) != 0u) return RAY_DIFFUSE;
    return ((flags & PATH_TRANSMITTED) != 0u ? RAY_TRANSMISSION : RAY_GLOSSY) | ((flags & PATH_SINGULAR) != 0u ? RAY_SINGULAR : 0u);
}
