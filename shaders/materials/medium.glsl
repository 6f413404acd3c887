// SPDX-License-Identifier: GPL-3.0-or-later
// Participating media of paths. Only materials with a volume fill the inside of their surfaces, and media that overlap
// add up, as in Cycles. A path carries the numbers of the media that it is in: the upper 20 bits of its flags have as
// many places as the scene's media leave room for, the lowest for the medium that it entered last; 0 is none. All paths
// are in medium 0, the world's. Scenes without media are compiled without MEDIA. The includer declares before the block
// Materials, and with MEDIA the block Media.

#include <Media>
const uint PATH_MASK = (1u << FIRST_MEDIUM) - 1u;

#ifdef MEDIA
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

// Coefficients of all media that a path is in, 1/m, and the radiance that they emit by length, W/(m^3 sr).
struct MediumCoefficients {
    vec3 absorption;
    vec3 scattering;
    vec3 emission;
};

// The number of a medium of a path, which is taken from the set of those that are left; the last is the world's, 0.
uint next_medium(inout uint set, uint bits) {
    uint medium = set & ((1u << bits) - 1u);
    set >>= bits;
    return medium;
}

MediumCoefficients path_medium(uint flags) {
    MediumCoefficients sum = MediumCoefficients(media[0].absorption, media[0].scattering, media[0].emission);
    uint bits = medium_bits();
    for (uint set = flags >> FIRST_MEDIUM; set != 0u;) {
        uint medium = next_medium(set, bits);
        sum.absorption += media[medium].absorption;
        sum.scattering += media[medium].scattering;
        sum.emission += media[medium].emission;
    }
    return sum;
}

// In 1/m.
vec3 path_extinction(uint flags) {
    MediumCoefficients medium = path_medium(flags);
    return medium.absorption + medium.scattering;
}

// Fraction of the light of a segment that is neither absorbed nor scattered.
vec3 segment_transmittance(uint flags, vec3 origin, vec3 direction, float distance) {
    return exp(-path_extinction(flags) * distance);
}

// Radiance that the media along a segment emit, at its beginning. A medium without extinction has no limit, and to
// infinity it gives none.
vec3 segment_emission(uint flags, vec3 origin, vec3 direction, float distance) {
    MediumCoefficients medium = path_medium(flags);
    vec3 extinction = medium.absorption + medium.scattering;
    vec3 depth = extinction * distance, series = distance * (1.0 - 0.5 * depth);
    vec3 length_seen = mix((1.0 - exp(-depth)) / max(extinction, vec3(1e-30)), series, lessThan(depth, vec3(1e-3)));
    return medium.emission * mix(length_seen, vec3(0.0), greaterThan(length_seen, vec3(1e20)));
}

// The flags of a path after it has passed through a surface of a material, which it came to from behind or not.
uint cross_surface(uint flags, uint material, bool backfacing) {
    uint medium = materials[material].medium;
    if (medium == 0u) return flags;
    uint set = flags >> FIRST_MEDIUM;
    set = backfacing ? leave_medium(set, medium) : enter_medium(set, medium);
    return (flags & PATH_MASK) | set << FIRST_MEDIUM;
}
#else
vec3 segment_transmittance(uint flags, vec3 origin, vec3 direction, float distance) { return vec3(1.0); }
vec3 segment_emission(uint flags, vec3 origin, vec3 direction, float distance) { return vec3(0.0); }
uint cross_surface(uint flags, uint material, bool backfacing) { return flags; }
#endif
