// SPDX-License-Identifier: GPL-3.0-or-later
// Tracing rays through two levels of bounding volume hierarchies (rppm_addon/integrator/bvh): a leaf of the top level
// holds world triangles, or an instance, whose mesh has a hierarchy of its own in object space.
//
// In a mesh's hierarchy the ray goes on in object space, where its direction keeps its scale: distances are those of
// the world. Its triangles are tested in the world, so that hits are the same as those of triangles that lie there.
#include "acceleration/instance_test.glsl"
#include "bvh/nodes.glsl"
#include "common/finite.glsl"
#include <InstanceLeaf>

// Stands on the stack below what is left of a mesh's hierarchy.
const uint TO_TOP_LEVEL = 0xffffffffu;
const uint IN_WORLD = 0xffffffffu;  // in place of the number of an instance

SlabTest object_slab_test(Ray ray, BottomLevelInstance instance) {
    mat3 linear = transpose(mat3(instance.to_object0.xyz, instance.to_object1.xyz, instance.to_object2.xyz));
    vec3 offset = vec3(instance.to_object0.w, instance.to_object1.w, instance.to_object2.w);
    return make_slab_test(linear * ray.origin + offset, linear * ray.direction, instance.margin);
}

Hit trace_ray(Ray ray, bool any_hit) {
    Hit best = Hit(NO_TRIANGLE, 0.0, 0.0, min(ray.maximum_distance, INFINITY_DISTANCE));
    float squared_length = dot(ray.direction, ray.direction);
    if (!(ray.maximum_distance > 0.0) || !is_finite(ray.origin) || !is_finite(ray.direction) || squared_length == 0.0) {
        return best;
    }
    InstanceTest test = make_instance_test(ray, any_hit);
    SlabTest world_slabs = make_slab_test(ray.origin, ray.direction, 0.0), slabs = world_slabs;
    uint stack[2 * MAX_DEPTH + 1];
    int top = 0;
    uint child = top_level.root, number = IN_WORLD;
    BottomLevelInstance instance;
    // Never reached: a ray meets a few hundred nodes.
    for (int count = 0; count < 60000; ++count) {
        bool is_at_end = true;
        if (child == TO_TOP_LEVEL) {
            slabs = world_slabs;
            number = IN_WORLD;
        } else if ((child & LEAF) == 0u) {
            BvhNode node = bvh_nodes[child];
            MetChildren met = met_children(node, slabs, best.distance);
            child = met.nearer;
            if (met.both) stack[top++] = met.farther;
            is_at_end = !met.any;
        } else if (number == IN_WORLD && (child & 3u) == INSTANCE_LEAF) {
            number = (child & ~LEAF) >> 2;
            instance = bottom_level_instances[number];
            is_at_end = !may_hit(test, instance);
            if (is_at_end) {
                number = IN_WORLD;
            } else {
                stack[top++] = TO_TOP_LEVEL;
                slabs = object_slab_test(ray, instance);
                child = instance.root;
            }
        } else {
            uint first = (child & ~LEAF) >> 2, end = first + (child & 3u);
            for (uint triangle = first; triangle < end; ++triangle) {
                if (number == IN_WORLD) test_triangle(test.triangles, triangle, best);
                else test_instance_triangle(test, instance, uvec2(number, triangle), best);
            }
            if (any_hit && best.triangle != NO_TRIANGLE) break;
        }
        if (is_at_end) {
            if (top == 0) break;
            child = stack[--top];
        }
    }
    return best;
}

#include "acceleration/instance_queries.glsl"
