// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of rays with triangles of instances, which are placed in the world for the test.
#include "acceleration/instances.glsl"
#include "acceleration/ray_test.glsl"

// In a hit, the triangle of an instance's mesh; which instance it is, hit_instance says. Of equal distances, world
// triangles come before these.
const uint ON_INSTANCE = 0x80000000u;
uint hit_instance = NO_TRIANGLE;

// What stays the same along a ray.
struct InstanceTest {
    RayTest triangles;
    uvec2 source_origin;  // the instance and its triangle that the ray comes from
#if defined(SHADOW_RAYS) && defined(INSTANCED_EMITTERS)
    uvec2 target_origin;  // that a shadow ray ends on, and is not hidden by
#endif
};

InstanceTest make_instance_test(Ray ray, bool any_hit) {
    uvec2 origin;
    if (!find_origin(ray.source_triangle, origin)) origin = uvec2(NO_TRIANGLE);
#if defined(SHADOW_RAYS) && defined(INSTANCED_EMITTERS)
    uvec2 target;
    if (!find_origin(target_triangle, target)) target = uvec2(NO_TRIANGLE);
    return InstanceTest(make_ray_test(ray, any_hit), origin, target);
#else
    return InstanceTest(make_ray_test(ray, any_hit), origin);
#endif
}

bool is_on_instance(Hit hit) { return hit.triangle != NO_TRIANGLE && (hit.triangle & ON_INSTANCE) != 0u; }

uvec2 hit_origin(Hit hit) { return uvec2(hit_instance, hit.triangle & ~ON_INSTANCE); }

// Whether a ray may hit any triangle of an instance.
bool may_hit(InstanceTest test, BottomLevelInstance instance) {
#ifdef TRACES_INSTANCES
    if (traced_instance != ALL_INSTANCES) return traced_instance == instance.placement;
#endif
    if (!is_shadow_ray(test.triangles)) return true;
#ifdef SHADOW_LINKING
    if (!has_set(shadow_sets, shadow_set_of(instance.set_code))) return false;
#endif
    return !(instance.set_code > 0.0);  // else it casts no shadow
}

// origin: the instance and the triangle of its mesh.
void test_instance_triangle(InstanceTest test, BottomLevelInstance instance, uvec2 origin, inout Hit best) {
    if (origin == test.source_origin) return;
#if defined(SHADOW_RAYS) && defined(INSTANCED_EMITTERS)
    if (origin == test.target_origin) return;
#endif
    vec3 v0, v1, v2;
    placed_triangle(instance, origin.y, v0, v1, v2);
#ifdef ONE_SIDED_TRIANGLES
    bool from_within = dot(cross(v1 - v0, v2 - v0), test.triangles.direction) > 0.0;
    if (from_within && is_one_sided(instance.set_code)) return;
#endif
#ifdef COUNT_TRAVERSAL
    ++triangle_tests;
#endif
    Hit found = Hit(NO_TRIANGLE, 0.0, 0.0, best.distance);
    intersect_triangle(test.triangles.ray, origin.y, v0, v1, v2, found);
    if (found.triangle == NO_TRIANGLE) return;
    // Of equal distances the instance, then the triangle of the lower number is hit.
    if (found.distance == best.distance && best.triangle != NO_TRIANGLE) {
        bool is_lower = origin.x < hit_instance || (origin.x == hit_instance && origin.y < hit_origin(best).y);
        if (!is_on_instance(best) || !is_lower) return;
    }
    best = found;
    best.triangle |= ON_INSTANCE;
    hit_instance = origin.x;
}
