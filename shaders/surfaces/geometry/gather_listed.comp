#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of instances that the host has listed become world-space triangles. HitOrigins holds the number of the
// instance and the triangle of its mesh for each place. Triangles and Attributes begin with the first of these.

layout(local_size_x = 64) in;

#include <GatherHitsParameters>
#include "common/invocation.glsl"
#include "surfaces/geometry/gather_triangle.glsl"
uniform Parameters { GatherHitsParameters parameters; };
readonly buffer HitOrigins;

void main() {
    uint place = invocation_index();
    if (place >= parameters.hit_count) return;
    uvec2 origin = hit_origins[parameters.first_hit + place];
    gather_triangle(origin.x, origin.y, place, parameters.fallback_point);
}
