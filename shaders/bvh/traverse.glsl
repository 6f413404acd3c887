// SPDX-License-Identifier: GPL-3.0-or-later
// Tracing rays through a bounding volume hierarchy (rppm_addon/integrator/bvh), for kernels that include TRAVERSAL.
//
// A node holds the boxes of both of its children. A ray goes on with the nearer of those that it meets and puts the
// other one on a stack. Which one comes first changes no hit, only how soon a hit is found.
#include "acceleration/one_level.glsl"
#include "acceleration/ray_test.glsl"
#include "bvh/nodes.glsl"
#include "common/finite.glsl"

Hit trace_ray(Ray ray, bool any_hit) {
    Hit best = Hit(NO_TRIANGLE, 0.0, 0.0, min(ray.maximum_distance, INFINITY_DISTANCE));
    float squared_length = dot(ray.direction, ray.direction);
    if (!(ray.maximum_distance > 0.0) || !is_finite(ray.origin) || !is_finite(ray.direction) || squared_length == 0.0) {
        return best;
    }
    RayTest test = make_ray_test(ray, any_hit);
    SlabTest slabs = make_slab_test(ray.origin, ray.direction, 0.0);
    uint stack[MAX_DEPTH];
    int top = 0;
    uint child = 0u;
    // Never reached: a ray meets a few hundred nodes.
    for (int count = 0; count < 60000; ++count) {
        bool is_at_end;
        if ((child & LEAF) != 0u) {
            uint first = (child & ~LEAF) >> 2, end = first + (child & 3u);
            for (uint triangle = first; triangle < end; ++triangle) test_triangle(test, triangle, best);
            if (any_hit && best.triangle != NO_TRIANGLE) break;
            is_at_end = true;
        } else {
            BvhNode node = bvh_nodes[child];
            MetChildren met = met_children(node, slabs, best.distance);
            child = met.nearer;
            if (met.both) stack[top++] = met.farther;
            is_at_end = !met.any;
        }
        if (is_at_end) {
            if (top == 0) break;
            child = stack[--top];
        }
    }
    return best;
}

// The nearest hit within ray.maximum_distance (which may be it); best.triangle NO_TRIANGLE if none.
Hit nearest_hit(Ray ray) { return trace_ray(ray, false); }

// Whether anything lies within ray.maximum_distance.
bool is_occluded(Ray ray) { return trace_ray(ray, true).triangle != NO_TRIANGLE; }
