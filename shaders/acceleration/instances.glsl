// SPDX-License-Identifier: GPL-3.0-or-later
// Instances whose triangles are placed in the world by the rays that meet them.
//
// A hit on such an instance gets the number of a hit triangle, behind those of the world triangles. HitOrigins says
// which triangle of which instance that is. Each path has two such numbers, so that the triangle that its ray comes
// from keeps its own. A kernel that only looks at hits itself need not give its paths numbers: it has two that no other
// kernel sees.
#include "acceleration/triangles.glsl"
#include "common/constants.glsl"
#include "common/placed_point.glsl"
#include <TopLevel>
#include <BottomLevelInstance>

readonly buffer TopLevelState;
restrict readonly buffer BottomLevelInstances;
restrict buffer HitOrigins;

// The first of the two hit triangles of the thread's path, counted from first_hit_triangle.
uint path_hits = NO_TRIANGLE;
uvec2 own_origin0 = uvec2(NO_TRIANGLE), own_origin1 = uvec2(NO_TRIANGLE);

// Gives the hits of the thread's path two hit triangles, from this one on.
void begin_path(uint first_of_path) { path_hits = first_of_path; }

// The vertices of a triangle of an instance's mesh in the world.
void placed_triangle(BottomLevelInstance instance, uint triangle, out vec3 v0, out vec3 v1, out vec3 v2) {
    mat3 linear = transpose(mat3(instance.row0.xyz, instance.row1.xyz, instance.row2.xyz));
    vec3 origin = vec3(instance.row0.w, instance.row1.w, instance.row2.w);
    uint first = 3u * (instance.first_triangle + triangle), turned = instance.mirrored;
    v0 = placed_point(linear, origin, world_vertex(first).xyz - instance.pivot);
    v1 = placed_point(linear, origin, world_vertex(first + 1u + turned).xyz - instance.pivot);
    v2 = placed_point(linear, origin, world_vertex(first + 2u - turned).xyz - instance.pivot);
}

// The instance, of BottomLevelInstances, and the triangle of its mesh that a hit triangle stands for; false for world
// triangles.
bool find_origin(uint triangle, out uvec2 origin) {
    uint place = triangle - top_level.first_hit_triangle, own = place - top_level.hit_triangle_count;
    origin = own == 0u ? own_origin0 : own_origin1;
    if (own < 2u) return true;
    if (place >= top_level.hit_triangle_count) return false;
    origin = hit_origins[place];
    return true;
}

bool is_hit_triangle(uint triangle) {
    return triangle - top_level.first_hit_triangle < top_level.hit_triangle_count + 2u;
}

// A number for a hit; source: the triangle that its ray comes from.
uint keep_hit(uvec2 origin, uint source) {
    bool is_own = path_hits == NO_TRIANGLE;
    uint first = top_level.first_hit_triangle + (is_own ? top_level.hit_triangle_count : path_hits);
    uint other = source == first ? 1u : 0u;
    if (!is_own) hit_origins[path_hits + other] = origin;
    else if (other == 0u) own_origin0 = origin;
    else own_origin1 = origin;
    return first + other;
}

vec4 triangle_vertex(uint number) {
    uvec2 origin;
    if (!find_origin(number / 3u, origin)) return world_vertex(number);
    BottomLevelInstance instance = bottom_level_instances[origin.x];
    vec3 v0, v1, v2;
    placed_triangle(instance, origin.y, v0, v1, v2);
    uint corner = number % 3u;
    return vec4(corner == 0u ? v0 : corner == 1u ? v1 : v2, corner == 0u ? instance.set_code : 0.0);
}
