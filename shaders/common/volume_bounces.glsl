// SPDX-License-Identifier: GPL-3.0-or-later
// The limit of Volume Bounces, counted from the camera as Cycles does: behind the last bounce in a medium a path takes
// direct light only. Light that specular surfaces alone have sent there counts as direct. The includer includes
// common/iteration.glsl, common/photon.glsl and common/path_depth.glsl before.

// Whether nothing but specular surfaces has scattered light, or nothing at all the light of a medium, whose photons
// begin as those that a rough surface has scattered.
bool is_light_direct(uint photon_flags, uint depth) {
#ifdef EMISSIVE_MEDIA
    if (bounces_of(depth) == 0u) return true;
#endif
    return (photon_flags & PHOTON_AFTER_ROUGH_BOUNCE) == 0u;
}

// Whether a photon may count at an importon; own_vertices: of the camera path in media, with the importon.
bool within_volume_bounces(uint bounce_counts, uint photon_flags, uint depth, uint own_vertices) {
    if (iteration.volume_bounces >= MOST_MEDIUM_VERTICES) return true;
    uint before = medium_count(bounce_counts), count = before + own_vertices;
    if (count <= iteration.volume_bounces) return true;
    if (count > iteration.volume_bounces + 1u) return false;
    if (before > 0u) return (bounce_counts & FIRST_MEDIUM_LIT) != 0u;
    return is_light_direct(photon_flags, depth);
}
