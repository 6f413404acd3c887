// SPDX-License-Identifier: GPL-3.0-or-later
// Limits of the depth of photons where camera paths take them. The includer includes common/iteration.glsl,
// common/photon.glsl and common/path_depth.glsl, and declares the blocks Photons and PhotonOrigins before.

#ifdef MEDIA
#include "common/volume_bounces.glsl"
#endif

// Whether light has been scattered more often than any or its own is to, from what it lights first to the camera, or
// has passed more transparent surfaces. camera_depth: of the camera path; medium_vertices: of the camera path in
// media, with this one.
bool exceeds_depth(uint camera_depth, uint photon_number, uint medium_vertices) {
#ifdef MEDIA
    if (!within_volume_bounces(photons[photon_number].bounce_counts, photons[photon_number].flags,
                               photons[photon_number].depth, medium_vertices))
        return true;
#endif
    uint depth = camera_depth + (photons[photon_number].depth & DEPTH_MASK);
    uint most = iteration.max_bounces;
    if (iteration.limits_bounces != 0u)
        most = min(most, photon_origins[photon_path_of(photons[photon_number].path)].max_bounces);
    return bounces_of(depth) > most || transparents_of(depth) > iteration.transparent_max_bounces;
}
