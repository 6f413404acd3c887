#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// lint:
// lint: INSTANCED_EMITTERS=1
// lint: INSTANCED_EMITTERS=1 HIT_NUMBERS=surfaces/geometry/lights
// lint: INSTANCED_EMITTERS=1 HIT_NUMBERS=surfaces/geometry/sources
// The triangles of instances that the rays of a list of paths have hit, go to or come from become world-space
// triangles. Triangles and Attributes begin with the first hit triangle of the list.

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
#include HIT_NUMBERS "surfaces/geometry/hits/hit_number.glsl"

void main() {
    uint index = active_path();
    if (index == NO_PATH) return;
    uint place = hit_number(index) - top_level.first_hit_triangle - parameters.first_hit;
    if (place >= parameters.hit_count) return;
    uvec2 origin = hit_origins[parameters.first_hit + place];
    gather_triangle(bottom_level_instances[origin.x].placement, origin.y, place, parameters.fallback_point);
#ifdef INSTANCED_EMITTERS
    // By which programs that look for emission know the triangle (lights/two_levels/traits.glsl).
    triangle_vertices[3u * place + 1u].w = float(origin.y);
    triangle_vertices[3u * place + 2u].w = float(origin.x);
#endif
}
