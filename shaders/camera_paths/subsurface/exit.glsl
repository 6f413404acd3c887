// SPDX-License-Identifier: GPL-3.0-or-later
// Where a random walk has come out.

#include <Hit>
#include <SubsurfaceWalk>
readonly buffer Triangles;
readonly buffer Attributes;
#include "common/triangle_normal.glsl"
readonly buffer ExitHits;
readonly buffer SubsurfaceWalks;
readonly buffer WalkRays;

struct WalkExit {
    vec3 position;
    vec3 geometric;
    vec3 shading;
    float ray_offset;
};

// Normals are on the outside, which is where the walk leads.
WalkExit read_exit(uint index) {
    Hit hit = exit_hits[index];
    vec3 v0 = triangle_vertices[3u * hit.triangle].xyz, v1 = triangle_vertices[3u * hit.triangle + 1u].xyz,
         v2 = triangle_vertices[3u * hit.triangle + 2u].xyz;
    vec3 b = vec3(1.0 - hit.b1 - hit.b2, hit.b1, hit.b2);
    WalkExit exit_point;
    exit_point.position = b.x * v0 + b.y * v1 + b.z * v2;
    exit_point.geometric = normalize(cross(v1 - v0, v2 - v0));
    exit_point.ray_offset = ray_offset(exit_point.geometric, v0, v1, v2);
    bool turned = dot(exit_point.geometric, walk_rays[index].direction) < 0.0;
    if (turned) exit_point.geometric = -exit_point.geometric;
    vec3 shading = triangle_normal(hit.triangle, b);
    float size = length(shading);
    exit_point.shading = size > 1e-6 ? (turned ? -shading : shading) / size : exit_point.geometric;
    return exit_point;
}
