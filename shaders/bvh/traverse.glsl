// SPDX-License-Identifier: GPL-3.0-or-later
// Tracing rays through a bounding volume hierarchy (rppm_addon/integrator/bvh), for kernels that include TRAVERSAL.
//
// A node holds the boxes of both of its children. A ray goes on with the nearer of those that it meets and puts the
// other one on a stack. Which one comes first changes no hit, only how soon a hit is found.
#include "acceleration/ray_test.glsl"
#include "common/finite.glsl"
#include <BvhNodes>

restrict readonly buffer BvhNodes;

// What a ray needs for tests with boxes.
struct SlabTest {
    vec3 origin;
    vec3 inverse_direction;  // finite
};

// Where a ray enters a box, and whether it meets the box before a distance. Both ends give way by more than the
// rounding errors of the quotients, so that no box is missed whose triangle is hit.
bool meets_box(SlabTest slabs, vec3 low, vec3 high, float distance, out float enter) {
    vec3 a = (low - slabs.origin) * slabs.inverse_direction, b = (high - slabs.origin) * slabs.inverse_direction;
    vec3 near = min(a, b), far = max(a, b);
    enter = max(max(near.x, near.y), max(near.z, 0.0));
    float leave = min(min(far.x, far.y), min(far.z, distance));
    return enter * 0.999999 <= leave * 1.000001;
}

Hit trace_ray(Ray ray, bool any_hit) {
    Hit best = Hit(NO_TRIANGLE, 0.0, 0.0, min(ray.maximum_distance, INFINITY_DISTANCE));
    float squared_length = dot(ray.direction, ray.direction);
    if (!(ray.maximum_distance > 0.0) || !is_finite(ray.origin) || !is_finite(ray.direction) || squared_length == 0.0) {
        return best;
    }
    RayTest test = make_ray_test(ray, any_hit);
    bvec3 moves = greaterThan(abs(ray.direction), vec3(1e-30));
    SlabTest slabs = SlabTest(ray.origin, 1.0 / mix(vec3(1e-30), ray.direction, moves));
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
            float enter0, enter1;
            bool meets0 = meets_box(slabs, node.low0, node.high0, best.distance, enter0);
            bool meets1 = meets_box(slabs, node.low1, node.high1, best.distance, enter1);
            bool is_second_first = meets1 && (!meets0 || enter1 < enter0);
            child = is_second_first ? node.child1 : node.child0;
            if (meets0 && meets1) stack[top++] = is_second_first ? node.child0 : node.child1;
            is_at_end = !(meets0 || meets1);
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
