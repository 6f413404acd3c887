// SPDX-License-Identifier: GPL-3.0-or-later
// What rays of nodes ask of hits on instances. Normals come from the mesh, by the same operations as those of gathered
// triangles.
#include "acceleration/hits/two_levels.glsl"
#include "surfaces/geometry/corner_normals.glsl"
#include <InstanceEntry>

readonly buffer Instances;
readonly buffer TriangleCorners;

Hit trace_node_ray(Ray ray, bool any_hit) {
    Hit best = trace_ray(ray, any_hit);
    if (is_on_instance(best)) best.triangle = keep_hit(hit_origin(best), ray.source_triangle);
    return best;
}

uint mesh_triangle_of(Hit hit) {
    uvec2 origin;
    if (!find_origin(hit.triangle, origin)) return attributes[hit.triangle].mesh_triangle;
    return origin.y;
}

vec3 normal_of(Hit hit, vec3 b) {
    uvec2 origin;
    if (!find_origin(hit.triangle, origin)) return triangle_normal(hit.triangle, b);
    BottomLevelInstance placed = bottom_level_instances[origin.x];
    InstanceEntry instance = instances[placed.placement];
    mat3 linear = transpose(mat3(instance.row0.xyz, instance.row1.xyz, instance.row2.xyz));
    mat3 cofactors = cofactors_of(linear);
    bool mirrored = is_mirroring(linear, cofactors);
    uint first_corner = 3u * (instance.mesh_triangle + origin.y);
    uint first_vertex = 3u * (placed.first_triangle + origin.y);
    vec3 points[3], normal = vec3(0.0);
    for (uint k = 0u; k < 3u; ++k) {
        uint turned = mirrored && k > 0u ? 3u - k : k;
        points[k] = world_vertex(first_vertex + turned).xyz - instance.pivot;
    }
    vec3 face = cofactors * cross(points[1] - points[0], points[2] - points[0]);
    for (uint k = 0u; k < 3u; ++k) {
        uint turned = mirrored && k > 0u ? 3u - k : k;
        uint corner = instance.mesh_corner + triangle_corners[first_corner + turned];
        normal += b[k] * unpack_unit_vector(placed_normal(corner, cofactors, mirrored, face));
    }
    return normal;
}
