#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Of the paths of a list, those whose rays are to be traced, as a list.

layout(local_size_x = 64) in;

#include "common/active_paths.glsl"
readonly buffer Rays;
#include "common/active_paths/kept.glsl"

void main() {
    uint path = active_path();
    if (path != NO_PATH && rays[path].maximum_distance > 0.0) keep_path(path);
}
