// SPDX-License-Identifier: GPL-3.0-or-later
// What rays of nodes ask of hits, all of which are on world triangles.
#include "acceleration/hits/one_level.glsl"

Hit trace_node_ray(Ray ray, bool any_hit) { return trace_ray(ray, any_hit); }
uint mesh_triangle_of(Hit hit) { return attributes[hit.triangle].mesh_triangle; }
vec3 normal_of(Hit hit, vec3 b) { return triangle_normal(hit.triangle, b); }
