// SPDX-License-Identifier: GPL-3.0-or-later
// Which media a point is in, by the surfaces on the way to it or away from it. The includer declares before the blocks
// Attributes and Media, and parameters with boxes.
#include TRAVERSAL
#include "common/geometry.glsl"
#include "materials/medium.glsl"
#include HITS "media/one_level/hits.glsl"

// Of surfaces behind one another, those up to here count: llvmpipe ends loops of a thread after 65535 rounds in all.
const int MOST_CROSSINGS = 64;
// Nearly upward, as Cycles looks; edges of upright walls are met by chance only.
const vec3 OUTWARD = vec3(0.0137, 0.0073, 0.99987949);

// The surface with a medium that a ray comes to next, and where it goes on behind that.
struct Crossing {
    uint medium;
    bool leaves;
};

uint medium_of(uint triangle) { return media[material_of(triangle)].material_medium; }

Crossing next_crossing(inout Ray ray) {
    for (int count = 0; count < MOST_CROSSINGS; ++count) {
        Hit hit = nearest_hit(ray);
        if (hit.triangle == NO_TRIANGLE) break;
        vec3 v0 = triangle_vertex(3u * hit.triangle).xyz, v1 = triangle_vertex(3u * hit.triangle + 1u).xyz,
             v2 = triangle_vertex(3u * hit.triangle + 2u).xyz;
        vec3 normal = normalize(cross(v1 - v0, v2 - v0));
        bool leaves = dot(normal, ray.direction) > 0.0;
        vec3 position = (1.0 - hit.b1 - hit.b2) * v0 + hit.b1 * v1 + hit.b2 * v2;
        float offset = ray_offset(normal, v0, v1, v2);
        vec3 origin = position + (leaves ? offset : -offset) * normal;
        ray = Ray(origin, hit.triangle, ray.direction, ray.maximum_distance - hit.distance);
        uint medium = medium_of(hit.triangle);
        if (medium > 0u) return Crossing(medium, leaves);
        if (!(ray.maximum_distance > 0.0)) break;
    }
    return Crossing(0u, false);
}

bool may_cross(vec3 low, vec3 high) {
    for (uint k = 0u; k < parameters.box_count; ++k)
        if (all(lessThanEqual(low, parameters.boxes[k].high)) && all(greaterThanEqual(high, parameters.boxes[k].low)))
            return true;
    return false;
}

// Whether a surface with a medium is so near that which side of it a point is on would depend on rounding.
bool is_at_surface(vec3 point) {
    float near = max(1e-4, 1e-5 * (abs(point.x) + abs(point.y) + abs(point.z)));
    if (!may_cross(point - near, point + near)) return false;
    for (int axis = 0; axis < 3; ++axis) {
        vec3 direction = vec3(equal(ivec3(axis), ivec3(0, 1, 2)));
        Ray ray = Ray(point - near * direction, NO_TRIANGLE, direction, 2.0 * near);
        if (next_crossing(ray).medium > 0u) return true;
    }
    return false;
}

// The media at a point, from which the way leads outward: those that it leaves without having come into them.
uint media_at(vec3 point) {
    uint media = 0u, entered = 0u;
    if (!may_cross(point, point)) return media;
    Ray ray = Ray(point, NO_TRIANGLE, OUTWARD, INFINITY_DISTANCE);
    for (int count = 0; count < MOST_CROSSINGS; ++count) {
        Crossing crossing = next_crossing(ray);
        if (crossing.medium == 0u) break;
        uint without = leave_medium(entered, crossing.medium);
        if (!crossing.leaves) entered = enter_medium(entered, crossing.medium);
        else if (without != entered) entered = without;
        else media = enter_medium(media, crossing.medium);
    }
    return media;
}

// Those at a point, by the way from another where they are known.
uint media_beyond(vec3 known, uint media, vec3 point) {
    if (media == MEDIA_UNKNOWN) return media_at(point);
    vec3 way = point - known;
    float distance = length(way);
    if (distance == 0.0 || !may_cross(min(known, point), max(known, point))) return media;
    Ray ray = Ray(known, NO_TRIANGLE, way / distance, distance);
    for (int count = 0; count < MOST_CROSSINGS; ++count) {
        Crossing crossing = next_crossing(ray);
        if (crossing.medium == 0u) break;
        media = crossing.leaves ? leave_medium(media, crossing.medium) : enter_medium(media, crossing.medium);
        if (!(ray.maximum_distance > 0.0)) break;
    }
    return media;
}
