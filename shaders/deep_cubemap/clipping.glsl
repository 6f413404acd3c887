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

// The part of a ray within a cubemap: near the center it tests the core list, and walks cells only before and after
// that.
struct RayPart {
    float from, to;
    vec2 core;  // distances between which it tests the core list
    bool meets_core;
};

// origin: from the center; to: the distance up to which the ray is walked. False where it misses all that there is.
bool clip_ray(DeepCubemapState cubemap, vec3 origin, vec3 direction, float to, out RayPart part) {
    float squared_length = dot(direction, direction), closest = -dot(origin, direction) / squared_length;
    vec3 foot = origin + closest * direction;
    float squared_miss = dot(foot, foot);
    // All triangles are in the cubemap's ball; what is left of the ray outside need not be walked.
    float radius = 1.001 * cubemap.scene_radius + 1e-5 * length(origin);
    vec2 ball;
    if (!clip_to_ball(closest, squared_miss, squared_length, radius, ball)) return false;
    part.from = max(ball.x, 0.0);
    part.to = min(ball.y, to);
    clip_to_box(cubemap, origin, direction, part.from, part.to);
    if (!(part.from < part.to)) return false;
    part.meets_core = clip_to_ball(closest, squared_miss, squared_length, cubemap.core_radius, part.core)
                      && part.core.y > part.from && part.core.x < part.to;
    return true;
}
