#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint: MEDIA=1
// lint: MEDIA=1 HETEROGENEOUS_MEDIA=1
// lint: MEDIA=1 RAY_PORTALS=1
// Camera rays to which photon beams are to add light.

layout(local_size_x = 64) in;

#include <BeamTargetParameters>
#include "common/iteration.glsl"
#include "common/active_paths.glsl"
#include "common/geometry.glsl"
#include "common/path_depth.glsl"
#include "common/camera_path.glsl"
#include "common/bsdf/closure.glsl"
uniform Parameters { BeamTargetParameters parameters; };
readonly buffer Media;
#include "materials/medium.glsl"
#include "media/thin_media.glsl"
#include "media/straight_paths.glsl"
readonly buffer Rays;
readonly buffer CameraPaths;
readonly buffer Closures;
buffer BeamTargets;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    Ray ray = rays[index];
    CameraPath path = camera_paths[index];
    if (!(ray.maximum_distance > 0.0) || !is_straight(path)) return;
    if (bounces_of(path.depth) > iteration.camera_bounces) return;
    if (!path_may_scatter(path.flags) || !is_thin(path.flags, parameters.least_free_path)) return;
    float far = closure_hit(closures[index]) ? closures[index].distance : INFINITY_DISTANCE;
    atomicAdd(beam_target_count, 1u);
    beam_targets[index] = BeamTarget(ray.origin, parameters.segment, ray.direction, far, path.throughput, path.flags,
                                     path.depth, 0u, 0u, 0u);
}
