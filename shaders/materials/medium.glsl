// SPDX-License-Identifier: GPL-3.0-or-later
// Absorption inside closed surfaces. As in Cycles, only materials with a volume fill their inside,
// and volumes that overlap add up; a path remembers two of them.

layout(std430, binding = 10) readonly buffer Materials;

// A path's flags: 10 bits of its own, then two material numbers plus one, 11 bits each.
const uint MEDIUM_BITS = 11u, MEDIUM_MASK = 0x7ffu, FIRST_MEDIUM = 10u, SECOND_MEDIUM = 21u;
const uint PATH_MASK = 0x3ffu;

vec3 medium_absorption(uint medium) { return medium == 0u ? vec3(0.0) : materials[medium - 1u].absorption; }

vec3 path_absorption(uint flags) {
    return medium_absorption((flags >> FIRST_MEDIUM) & MEDIUM_MASK) + medium_absorption(flags >> SECOND_MEDIUM);
}

// What is left of the light of a segment that ends at the closure.
vec3 segment_transmittance(uint flags, Closure closure) {
    uint first = (flags >> FIRST_MEDIUM) & MEDIUM_MASK;
    vec3 absorption = path_absorption(flags);
    // A path that started inside learns so where it meets the surface from within.
    if (first == 0u && (closure.flags & CLOSURE_BACKFACING) != 0u) absorption = materials[closure.material].absorption;
    return exp(-absorption * closure.distance);
}

// The flags of a path after it has passed through the closure's surface.
uint cross_surface(uint flags, Closure closure) {
    uint medium = closure.material + 1u;
    if (medium > MEDIUM_MASK || materials[closure.material].absorption == vec3(0.0)) return flags;
    uint first = (flags >> FIRST_MEDIUM) & MEDIUM_MASK, second = flags >> SECOND_MEDIUM;
    if ((closure.flags & CLOSURE_BACKFACING) == 0u) {
        second = first;
        first = medium;
    } else if (first == medium) {
        first = second;
        second = 0u;
    } else if (second == medium) second = 0u;
    return (flags & PATH_MASK) | (first << FIRST_MEDIUM) | (second << SECOND_MEDIUM);
}
