// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a ray within the bounds of a cubemap.
#include <DeepCubemapState>
#include "deep_cubemap/sortable_bits.glsl"

// Distances at which the ray is within a radius of the center; false if it passes outside.
bool clip_to_ball(float closest, float squared_miss, float squared_length, float radius, out vec2 between) {
    float room = radius * radius - squared_miss;
    float half_chord = sqrt(max(room, 0.0) / squared_length);
    between = vec2(closest - half_chord, closest + half_chord);
    return room > 0.0;
}

// Part of [from, to] within the box around all triangles; axes along which the ray hardly moves are left aside.
void clip_to_box(DeepCubemapState cubemap, vec3 origin, vec3 direction, inout float from, inout float to) {
    vec3 low = from_sortable_bits(~cubemap.low_complement) - cubemap.margin;
    vec3 high = from_sortable_bits(cubemap.high) + cubemap.margin;
    bvec3 moves = greaterThan(abs(direction), vec3(1e-20));
    vec3 a = (low - origin) / direction, b = (high - origin) / direction;
    vec3 enter = mix(vec3(from), min(a, b), moves), leave = mix(vec3(to), max(a, b), moves);
    from = max(from, max(enter.x, max(enter.y, enter.z)));
    to = min(to, min(leave.x, min(leave.y, leave.z)));
}
