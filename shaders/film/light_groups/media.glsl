// SPDX-License-Identifier: GPL-3.0-or-later
// Light that media emit along the rays of camera paths, by the groups of the media. The includer includes
// film/light_groups/grouped.glsl and materials/medium.glsl before.

// Radiance of one of the media of a path along its ray, at the ray's origin: its part of segment_emission.
vec3 emission_of_medium(uint medium, uint flags, Ray ray, float distance) {
    vec3 extinction = even_extinction(flags);
#ifdef HETEROGENEOUS_MEDIA
    vec3 offset = lookup_offset(ray.origin, ray.direction);
    bool varies = has_grid(medium);
    if (varies && media[medium].channels >> 16u == NO_CHANNEL) return vec3(0.0);
    uint without = varies ? medium : MEDIA_UNKNOWN;
    extinction += grids_thickness(flags, ray.origin, ray.direction, distance, offset, without) / distance;
    if (varies) return grid_emission(medium, ray.origin, ray.direction, distance, offset, extinction);
#endif
    vec3 seen = seen_length(extinction, distance);
    return media[medium].emission * mix(seen, vec3(0.0), greaterThan(seen, vec3(1e20)));
}

// All that a final gather finds but for light of surfaces and photons counts for the world's group: what media emit is
// taken from it.
void add_emission_of_media(uint index, CameraPath path, Ray ray, float distance) {
    bool gathers = (path.flags & PATH_FINAL_GATHER) != 0u, world = true;
    uint bits = medium_bits(), set = path.flags >> FIRST_MEDIUM;
    while (world) {
        world = set != 0u;
        uint medium = world ? next_medium(set, bits) : 0u, group = media[medium].light_group;
        vec3 emitted = path.throughput * emission_of_medium(medium, path.flags, ray, distance);
        if (gathers) add_to_group(index, iteration.world_group, true, -emitted);
        if (group > 0u) add_to_group(index, group - 1u, gathers, emitted);
    }
}
