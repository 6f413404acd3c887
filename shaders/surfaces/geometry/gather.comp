#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Indexed meshes and their instances become world-space triangles.

layout(local_size_x = 64) in;

#include <GatherParameters>
#include "common/invocation.glsl"
#include "surfaces/geometry/gather_triangle.glsl"
uniform Parameters { GatherParameters parameters; };

void main() {
    uint index = invocation_index(), triangle = parameters.first_triangle + index;
    if (index >= parameters.triangle_count) return;
    uint number = instance_of(triangle, parameters.instance_count);
    gather_triangle(number, triangle - instances[number].first_triangle, index, parameters.fallback_point);
}
