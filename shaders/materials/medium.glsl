// SPDX-License-Identifier: GPL-3.0-or-later
// Absorption inside closed surfaces. As in Cycles, only materials with a volume fill their inside,
// and volumes that overlap add up; a path remembers two of them.

layout(std430, binding = 10) readonly buffer Materials;

// A path's flags: 12 bits of its own, then the numbers of two media, 10 bits each; 0 is none.
const uint MEDIUM_MASK = 0x3ffu, FIRST_MEDIUM = 12u, SECOND_MEDIUM = 22u;
const uint PATH_MASK = 0xfffu;

vec3 medium_absorption(uint medium) {
    return medium == 0u ? vec3(0.0) : materials[materials[medium - 1u].material_of_medium].absorption;
}

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
    uint medium = materials[closure.material].medium;
    if (medium == 0u) return flags;
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
