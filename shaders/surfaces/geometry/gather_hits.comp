#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of instances that the rays of a list of paths have hit become world-space triangles. Triangles and
// Attributes begin with the first hit triangle of the list.

layout(local_size_x = 64) in;

#include <GatherHitsParameters>
#include <TopLevel>
#include <BottomLevelInstance>
#include "common/active_paths.glsl"
#include "surfaces/geometry/gather_triangle.glsl"
uniform Parameters { GatherHitsParameters parameters; };
readonly buffer TopLevelState;
readonly buffer BottomLevelInstances;
readonly buffer HitOrigins;
readonly buffer Hits;

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    uint place = hits[index].triangle - top_level.first_hit_triangle - parameters.first_hit;
    if (place >= parameters.hit_count) return;
    uvec2 origin = hit_origins[parameters.first_hit + place];
    gather_triangle(bottom_level_instances[origin.x].placement, origin.y, place, parameters.fallback_point);
}
