// SPDX-License-Identifier: GPL-3.0-or-later
// Homogeneous media inside closed surfaces. As in Cycles, only materials with a volume fill their inside, and media
// that overlap add up. A path carries the numbers of those that it is in: the upper 20 bits of its flags have as many
// places as the scene's media leave room for, the lowest for the medium that it came into last; 0 is none.
// The includer declares before the block Materials.

#include <Media>
const uint PATH_MASK = (1u << FIRST_MEDIUM) - 1u;

uint medium_bits() { return materials[0].medium_bits; }

uint enter_medium(uint media, uint medium) {
    uint bits = medium_bits();
    return (media << bits | medium) & ((1u << (MEDIA_BITS / bits * bits)) - 1u);
}

// Without the place that holds the medium, of several the lowest; as it is where none does.
uint leave_medium(uint media, uint medium) {
    uint bits = medium_bits(), mask = (1u << bits) - 1u;
    for (uint at = 0u; (media >> at) != 0u; at += bits)
        if ((media >> at & mask) == medium) return (media & ((1u << at) - 1u)) | media >> (at + bits) << at;
    return media;
}

// Coefficients in 1/m, and radiance in W/(m^2 sr) by length.
struct Medium {
    vec3 absorption;
    vec3 emission;
};

Medium path_medium(uint flags) {
    Medium medium = Medium(vec3(0.0), vec3(0.0));
    uint bits = medium_bits(), mask = (1u << bits) - 1u;
    for (uint media = flags >> FIRST_MEDIUM; media != 0u; media >>= bits) {
        uint number = (media & mask) - 1u;
        medium.absorption += materials[number].medium_absorption;
        medium.emission += materials[number].medium_emission;
    }
    return medium;
}

vec3 path_absorption(uint flags) { return path_medium(flags).absorption; }

// What is left of the light of a segment.
vec3 segment_transmittance(uint flags, float distance) { return exp(-path_absorption(flags) * distance); }

// Radiance of the media along a segment, at its beginning. What does not absorb has no limit, and to infinity gives
// none.
vec3 segment_emission(uint flags, float distance) {
    if (flags >> FIRST_MEDIUM == 0u) return vec3(0.0);
    Medium medium = path_medium(flags);
    vec3 depth = medium.absorption * distance, series = distance * (1.0 - 0.5 * depth);
    vec3 length_seen =
        mix((1.0 - exp(-depth)) / max(medium.absorption, vec3(1e-30)), series, lessThan(depth, vec3(1e-3)));
    return medium.emission * mix(length_seen, vec3(0.0), greaterThan(length_seen, vec3(1e20)));
}

// The flags of a path after it has passed through a surface of a material, which it came to from behind or not.
uint cross_surface(uint flags, uint material, bool backfacing) {
    uint medium = materials[material].medium;
    if (medium == 0u) return flags;
    uint media = flags >> FIRST_MEDIUM;
    media = backfacing ? leave_medium(media, medium) : enter_medium(media, medium);
    return (flags & PATH_MASK) | media << FIRST_MEDIUM;
}
