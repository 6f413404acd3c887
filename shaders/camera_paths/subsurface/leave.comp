#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Where camera paths come out from below a surface, they are on a diffuse one.

layout(local_size_x = 64) in;

#include "common/active_paths.glsl"
#include "common/bsdf/closure.glsl"
writeonly buffer ExitClosures;
#include "camera_paths/subsurface/exit.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH || exit_hits[index].triangle == NO_TRIANGLE) return;
    WalkExit exit_point = read_exit(index);
    uint shading = pack_unit_vector(exit_point.shading);
    exit_closures[index].position = exit_point.position;
    exit_closures[index].triangle = exit_hits[index].triangle;
    exit_closures[index].diffuse = subsurface_walks[index].throughput;
    exit_closures[index].geometric_normal = pack_unit_vector(exit_point.geometric);
    exit_closures[index].shading_normal = shading;
    exit_closures[index].diffuse_normal = shading;
    exit_closures[index].diffuse_roughness = 0u;
    exit_closures[index].ray_offset = exit_point.ray_offset;
}
