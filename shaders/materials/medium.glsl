// SPDX-License-Identifier: GPL-3.0-or-later
// Participating media of paths. Only materials with a volume fill the inside of their surfaces, and media that overlap
// add up, as in Cycles. A path carries the numbers of the media that it is in: the upper 20 bits of its flags have as
// many places as the scene's media leave room for, the lowest for the medium that it entered last; 0 is none. All paths
// are in medium 0, the world's. Scenes without media are compiled without MEDIA. With MEDIA the includer declares
// before the block Media.

#include <Media>
const uint PATH_MASK = (1u << FIRST_MEDIUM) - 1u;

// Coefficients of media, 1/m, and the radiance that they emit by length, W/(m^3 sr).
struct MediumCoefficients {
    vec3 absorption;
    vec3 scattering;
    vec3 emission;
};

// A place on the ray of a path.
struct PlaceOnRay {
    vec3 origin;
    vec3 direction;
    float distance;  // meters
};

// Length of a segment weighted by how much of the light from each of its places reaches its beginning, meters. The
// series serves where the formula cancels.
vec3 seen_length(vec3 extinction, float distance) {
    vec3 depth = extinction * distance, series = distance * (1.0 - 0.5 * depth);
    return mix((1.0 - exp(-depth)) / max(extinction, vec3(1e-30)), series, lessThan(depth, vec3(1e-3)));
}

#include "media/grid.glsl"

#ifdef MEDIA
uint medium_bits() { return media[0].medium_bits; }

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

// The number of a medium of a path, which is taken from the set of those that are left; the last is the world's, 0.
uint next_medium(inout uint set, uint bits) {
    uint medium = set & ((1u << bits) - 1u);
    set >>= bits;
    return medium;
}

// The sum over the media of a path that are the same everywhere.
MediumCoefficients even_medium(uint flags) {
    MediumCoefficients sum = MediumCoefficients(vec3(0.0), vec3(0.0), vec3(0.0));
    if (!has_grid(0u)) sum = MediumCoefficients(media[0].absorption, media[0].scattering, media[0].emission);
    uint bits = medium_bits();
    for (uint set = flags >> FIRST_MEDIUM; set != 0u;) {
        uint medium = next_medium(set, bits);
        if (has_grid(medium)) continue;
        sum.absorption += media[medium].absorption;
        sum.scattering += media[medium].scattering;
        sum.emission += media[medium].emission;
    }
    return sum;
}

vec3 even_extinction(uint flags) {
    MediumCoefficients medium = even_medium(flags);
    return medium.absorption + medium.scattering;
}

#ifdef HETEROGENEOUS_MEDIA
// The next medium of a path that has a grid, which is taken from the set of those that are left; false where there is
// none. The world's is the last, which is in no set.
bool next_grid(inout uint set, inout bool world, out uint medium) {
    for (uint bits = medium_bits(); set != 0u;) {
        medium = next_medium(set, bits);
        if (has_grid(medium)) return true;
    }
    medium = 0u;
    bool found = world && has_grid(0u);
    world = false;
    return found;
}

// Coefficients of all media that a path is in at a place on its ray.
MediumCoefficients path_medium(uint flags, PlaceOnRay at) {
    MediumCoefficients sum = even_medium(flags);
    bool world = true;
    uint medium;
    for (uint set = flags >> FIRST_MEDIUM; next_grid(set, world, medium);) {
        MediumCoefficients grid = grid_coefficients(medium, at);
        sum.absorption += grid.absorption;
        sum.scattering += grid.scattering;
        sum.emission += grid.emission;
    }
    return sum;
}

// Optical thickness of the grids of a path along a segment; without: a medium that does not count.
vec3 grids_thickness(uint flags, vec3 origin, vec3 direction, float distance, vec3 offset, uint without) {
    vec3 thickness = vec3(0.0);
    bool world = true;
    uint medium;
    for (uint set = flags >> FIRST_MEDIUM; next_grid(set, world, medium);)
        if (medium != without) thickness += grid_thickness(medium, origin, direction, distance, offset);
    return thickness;
}

// Optical thickness of all media that a path is in along a segment.
vec3 segment_thickness(uint flags, vec3 origin, vec3 direction, float distance) {
    return even_extinction(flags) * distance
           + grids_thickness(flags, origin, direction, distance, lookup_offset(origin, direction), MEDIA_UNKNOWN);
}

// The distance along a segment at which a path collides with its media, INFINITY_DISTANCE where it does not: where
// the optical thickness of a channel comes to that of a random number u in [0, 1). Of several media, each has a free
// flight of its own, of which the shortest is distributed as that of all together. passed: the thickness of all
// media up
// to there, or along the whole segment.
float segment_free_flight(uint flags, vec3 origin, vec3 direction, float distance, int channel, float u,
                          out vec3 passed) {
    vec3 even = even_extinction(flags);
    float thickness = -log(max(1.0 - u, 1e-30)), flight = even[channel] > 0.0 ? thickness / even[channel] : distance;
    bool collides = flight < distance;
    flight = min(flight, distance);
    vec3 offset = lookup_offset(origin, direction);
    bool world = true;
    uint medium, number = 0u;
    passed = vec3(0.0);
    for (uint set = flags >> FIRST_MEDIUM; next_grid(set, world, medium); ++number) {
        if (even[channel] > 0.0 || number > 0u)
            thickness = -log(1.0 - unit_float(pcg4d(uvec4(floatBitsToUint(u), number, iteration.number, medium)).x));
        float next = grid_free_flight(medium, origin, direction, flight, offset, channel, thickness, passed);
        if (next < flight) {
            flight = next;
            collides = true;
        }
    }
    if (number > 1u) passed = grids_thickness(flags, origin, direction, flight, offset, MEDIA_UNKNOWN);
    passed += even * flight;
    return collides ? flight : INFINITY_DISTANCE;
}

// Radiance that the media along a segment emit, at its beginning. Where a path is in several grids, each sees the
// others' extinction spread evenly over the segment.
vec3 segment_emission(uint flags, vec3 origin, vec3 direction, float distance) {
    MediumCoefficients even = even_medium(flags);
    vec3 extinction = even.absorption + even.scattering, offset = lookup_offset(origin, direction);
    vec3 emitted = vec3(0.0);
    bool world = true;
    uint medium;
    for (uint set = flags >> FIRST_MEDIUM; next_grid(set, world, medium);) {
        if (media[medium].channels >> 16u == NO_CHANNEL) continue;
        vec3 others = grids_thickness(flags, origin, direction, distance, offset, medium) / distance;
        emitted += grid_emission(medium, origin, direction, distance, offset, extinction + others);
    }
    if (even.emission == vec3(0.0)) return emitted;
    extinction += grids_thickness(flags, origin, direction, distance, offset, MEDIA_UNKNOWN) / distance;
    vec3 seen = seen_length(extinction, distance);
    return emitted + even.emission * mix(seen, vec3(0.0), greaterThan(seen, vec3(1e20)));
}
#else
// Coefficients of all media that a path is in at a place on its ray.
MediumCoefficients path_medium(uint flags, PlaceOnRay at) { return even_medium(flags); }

// Optical thickness of all media that a path is in along a segment.
vec3 segment_thickness(uint flags, vec3 origin, vec3 direction, float distance) {
    return even_extinction(flags) * distance;
}

// Radiance that the media along a segment emit, at its beginning. A medium without extinction has no limit, and to
// infinity it gives none.
vec3 segment_emission(uint flags, vec3 origin, vec3 direction, float distance) {
    MediumCoefficients medium = even_medium(flags);
    vec3 extinction = medium.absorption + medium.scattering;
    vec3 seen = seen_length(extinction, distance);
    return medium.emission * mix(seen, vec3(0.0), greaterThan(seen, vec3(1e20)));
}
#endif

// Fraction of the light of a segment that is neither absorbed nor scattered.
vec3 segment_transmittance(uint flags, vec3 origin, vec3 direction, float distance) {
    return exp(-segment_thickness(flags, origin, direction, distance));
}

// The sum over the media of a path of their scattering coefficients where they are densest.
vec3 most_scattering(uint flags) {
    vec3 sum = media[0].scattering;
    uint bits = medium_bits();
    for (uint set = flags >> FIRST_MEDIUM; set != 0u;) sum += media[next_medium(set, bits)].scattering;
    return sum;
}

// Whether a medium of a path scatters light anywhere.
bool path_may_scatter(uint flags) {
    vec3 sum = most_scattering(flags);
    return max(sum.x, max(sum.y, sum.z)) > 0.0;
}

// The flags of a path after it has passed through a surface of a material, which it came to from behind or not.
uint cross_surface(uint flags, uint material, bool backfacing) {
    uint medium = media[material].material_medium;
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
