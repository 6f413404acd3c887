// SPDX-License-Identifier: GPL-3.0-or-later
// Tracing rays through two levels of deep cubemaps (rppm_addon/integrator/deep_cubemap/levels.py). The top level is two
// cubemaps around the scene's center: one of world triangles, and one of instances, in which a cell lists the boxes of
// these by depth. The mesh of an instance has a cubemap of its own in object space.
//
// In a mesh's cubemap the ray goes on in object space, where its direction keeps its scale: distances are those of the
// world. Its triangles are tested in the world, so that hits are the same as those of triangles that lie there.
#include "acceleration/instance_test.glsl"
#include "bvh/boxes.glsl"
#include "common/finite.glsl"
#include "deep_cubemap/walk.glsl"
#include "deep_cubemap/clusters.glsl"
#include <CubemapLevels>

restrict readonly buffer DeepCubemaps;

// Instances that the ray has been through: a large one lies in many cells.
struct Visited {
    uvec4 last, before;
};

bool has_visited(Visited visited, uint number) {
    return any(equal(visited.last, uvec4(number))) || any(equal(visited.before, uvec4(number)));
}

void visit(inout Visited visited, uint number) {
    visited.before = uvec4(visited.last.w, visited.before.xyz);
    visited.last = uvec4(number, visited.last.xyz);
}

// The distance at which the ray enters the box of an instance's mesh; false where it does not before `nearest`.
bool meets_mesh(DeepCubemapState mesh, vec3 origin, vec3 direction, float nearest, out float enter) {
    vec3 low = from_sortable_bits(~mesh.low_complement) - mesh.margin;
    vec3 high = from_sortable_bits(mesh.high) + mesh.margin;
    return meets_box(make_slab_test(origin, direction, 0.0), low, high, nearest, enter);
}

// latest: a distance behind which the ray is yet to come to the instance. Returns whether it has come to it.
bool test_instance(Ray ray, InstanceTest test, uint number, float latest, inout Hit best) {
    BottomLevelInstance instance = bottom_level_instances[number];
    if (!may_hit(test, instance)) return true;
    DeepCubemapState mesh = deep_cubemaps[instance.root];
    mat3 linear = transpose(mat3(instance.to_object0.xyz, instance.to_object1.xyz, instance.to_object2.xyz));
    vec3 offset = vec3(instance.to_object0.w, instance.to_object1.w, instance.to_object2.w) - mesh.center;
    vec3 direction = linear * ray.direction;
    if (!is_finite(direction) || dot(direction, direction) == 0.0) return true;
    float start;
    if (!meets_mesh(mesh, linear * ray.origin + offset, direction, best.distance, start)) return true;
    if (start > latest) return false;
    // The ray begins where it enters the mesh's box: from far away its places in cells would be less exact.
    start *= 0.9999;
    vec3 origin = linear * (ray.origin + start * ray.direction) + offset;
    CubemapWalk walk;
    CellItems items;
    if (!begin_walk(mesh, origin, direction, 1.000001 * best.distance - start, walk)) return true;
    while (next_items(walk, best.distance - start, items)) {
        uint item;
        while (next_item(walk, items, best.distance - start, item)) {
            uint first = items.is_core ? item : cluster_first(item);
            uint end = first + (items.is_core ? 1u : cluster_size(item));
            for (uint triangle = first; triangle < end; ++triangle) {
                test_instance_triangle(test, instance, uvec2(number, triangle), best);
            }
            if (test.triangles.any_hit && best.triangle != NO_TRIANGLE) return true;
        }
        if (best.distance - start <= items.exit) return true;
    }
    return true;
}

void test_cluster(RayTest test, uint item, bool is_core, inout Hit best) {
    uint first = is_core ? item : cluster_first(item), end = first + (is_core ? 1u : cluster_size(item));
    for (uint triangle = first; triangle < end; ++triangle) test_triangle(test, triangle, best);
}

Hit trace_ray(Ray ray, bool any_hit) {
    Hit best = Hit(NO_TRIANGLE, 0.0, 0.0, min(ray.maximum_distance, INFINITY_DISTANCE));
    float squared_length = dot(ray.direction, ray.direction);
    if (!(ray.maximum_distance > 0.0) || !is_finite(ray.origin) || !is_finite(ray.direction) || squared_length == 0.0) {
        return best;
    }
    InstanceTest test = make_instance_test(ray, any_hit);
    Visited visited = Visited(uvec4(NO_TRIANGLE), uvec4(NO_TRIANGLE));
    for (uint level = WORLD_LEVEL; level <= INSTANCE_LEVEL; ++level) {
        DeepCubemapState cubemap = deep_cubemaps[level];
        CubemapWalk walk;
        CellItems items;
        if (!begin_walk(cubemap, ray.origin - cubemap.center, ray.direction, best.distance, walk)) continue;
        while (next_items(walk, best.distance, items)) {
            // A box that the ray enters behind this cell is listed in another one; with some slack for rounding.
            float latest = items.is_core ? INFINITY_DISTANCE : 1.00001 * items.exit + 16.0 * cubemap.margin;
            uint item;
            while (next_item(walk, items, best.distance, item)) {
                if (level == WORLD_LEVEL) {
                    test_cluster(test.triangles, item, items.is_core, best);
                } else if (!has_visited(visited, item)) {
                    if (test_instance(ray, test, item, latest, best)) visit(visited, item);
                }
                if (any_hit && best.triangle != NO_TRIANGLE) return best;
            }
            if (best.distance <= items.exit) break;
        }
    }
    return best;
}

#include "acceleration/instance_queries.glsl"
