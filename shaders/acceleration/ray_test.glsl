// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of rays with triangles, whatever structure leads to these.
#include "common/constants.glsl"
#include "common/intersection.glsl"
#include "acceleration/triangles.glsl"
#ifdef ONE_SIDED_TRIANGLES
#include "common/light_sets.glsl"
#endif

#ifdef TRACES_INSTANCES
// Rays may hit triangles of one instance only, or of all. The includer declares before the block Attributes.
const uint ALL_INSTANCES = 0xffffffffu;
uint traced_instance = ALL_INSTANCES;
#endif

#ifdef SHADOW_RAYS
uint target_triangle = NO_TRIANGLE;  // that a shadow ray ends on, and is not hidden by
#endif

#ifdef COUNT_TRAVERSAL
uint triangle_tests = 0u;
#endif

// What stays the same along a ray.
struct RayTest {
    WatertightRay ray;
    vec3 direction;
    uint source_triangle;  // never hit
    bool any_hit;          // the first hit found will do
};

RayTest make_ray_test(Ray ray, bool any_hit) {
    return RayTest(make_watertight_ray(ray.origin, ray.direction), ray.direction, ray.source_triangle, any_hit);
}

// Whether what casts no shadow is passed.
bool is_shadow_ray(RayTest test) {
#ifdef NEAREST_SHADOW
    return true;
#else
    return test.any_hit;
#endif
}

void test_triangle(RayTest test, uint triangle, inout Hit best) {
    if (triangle == test.source_triangle) return;
#ifdef SHADOW_RAYS
    if (triangle == target_triangle) return;
#endif
    vec4 vertex0 = world_vertex(3u * triangle);
#ifdef TRACES_INSTANCES
    bool of_all = traced_instance == ALL_INSTANCES;
#else
    const bool of_all = true;
#endif
    if (of_all && is_shadow_ray(test) && vertex0.w > 0.0) return;  // casts no shadow
#ifdef ONE_SIDED_TRIANGLES
    vec3 vertex1 = world_vertex(3u * triangle + 1u).xyz, vertex2 = world_vertex(3u * triangle + 2u).xyz;
    bool from_within = dot(cross(vertex1 - vertex0.xyz, vertex2 - vertex0.xyz), test.direction) > 0.0;
    if (from_within && is_one_sided(vertex0.w)) return;
#endif
#ifdef SHADOW_LINKING
    if (is_shadow_ray(test) && !has_set(shadow_sets, shadow_set_of(vertex0.w))) return;
#endif
#ifdef COUNT_TRAVERSAL
    ++triangle_tests;
#endif
#ifdef TRACES_INSTANCES
    Hit before = best;
#endif
    intersect_triangle(test.ray, triangle, vertex0.xyz, world_vertex(3u * triangle + 1u).xyz,
                       world_vertex(3u * triangle + 2u).xyz, best);
#ifdef TRACES_INSTANCES
    // Asked last, as few triangles are hit.
    if (!of_all && best.triangle == triangle && attributes[triangle].instance != traced_instance) best = before;
#endif
}
