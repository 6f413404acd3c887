// SPDX-License-Identifier: GPL-3.0-or-later
// Watertight ray and triangle test (Woop, Benthin, Wald, JCGT 2013): the triangle is moved into a
// space where the ray runs along z from the origin, so that two triangles which share an edge
// compute the edge's side from the same numbers. `precise` keeps compilers from contracting
// a * b - c * d, which would break that, and makes all kernels agree bit for bit.
#include "common/constants.glsl"
#include <Ray>
#include <Hit>

struct WatertightRay {
    vec3 origin;
    int axis;  // along which the direction is longest
    vec3 shear;
};

// Coordinates turned so that `axis` comes last.
vec3 axis_last(vec3 v, int axis) { return axis == 0 ? v.yzx : (axis == 1 ? v.zxy : v); }

WatertightRay make_watertight_ray(vec3 origin, vec3 direction) {
    WatertightRay ray;
    ray.origin = origin;
    vec3 size = abs(direction);
    ray.axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    precise vec3 turned = axis_last(direction, ray.axis);
    precise vec3 shear = vec3(turned.x / turned.z, turned.y / turned.z, 1.0 / turned.z);
    ray.shear = shear;
    return ray;
}

// Takes the triangle as the best hit if it lies ahead (distance > 0) and nearer than `best`; of equal
// distances the lower triangle number wins, so that the order of the tests does not matter.
// Start with best.triangle = NO_TRIANGLE and best.distance = the longest distance allowed.
void intersect_triangle(WatertightRay ray, uint triangle, vec3 vertex0, vec3 vertex1, vec3 vertex2, inout Hit best) {
    precise vec3 a = axis_last(vertex0 - ray.origin, ray.axis);
    precise vec3 b = axis_last(vertex1 - ray.origin, ray.axis);
    precise vec3 c = axis_last(vertex2 - ray.origin, ray.axis);
    precise vec2 a2 = a.xy - ray.shear.xy * a.z;
    precise vec2 b2 = b.xy - ray.shear.xy * b.z;
    precise vec2 c2 = c.xy - ray.shear.xy * c.z;
    // Rounding can zero the areas of a triangle that is tiny as seen from far away, wherever the ray passes.
    if (any(greaterThan(min(min(a2, b2), c2), vec2(0.0))) || any(lessThan(max(max(a2, b2), c2), vec2(0.0)))) return;
    // twice the areas that the ray's point makes with each edge; zero counts as inside on both sides
    precise float area0 = c2.x * b2.y - c2.y * b2.x;
    precise float area1 = a2.x * c2.y - a2.y * c2.x;
    precise float area2 = b2.x * a2.y - b2.y * a2.x;
    if ((area0 < 0.0 || area1 < 0.0 || area2 < 0.0) && (area0 > 0.0 || area1 > 0.0 || area2 > 0.0)) return;
    precise float area = area0 + area1 + area2;
    if (area == 0.0) return;
    precise float distance = (area0 * a.z + area1 * b.z + area2 * c.z) * ray.shear.z / area;
    if (!(distance > 0.0)) return;
    if (distance < best.distance || (distance == best.distance && triangle < best.triangle)) {
        best = Hit(triangle, area1 / area, area2 / area, distance);
    }
}
