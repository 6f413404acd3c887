// SPDX-License-Identifier: GPL-3.0-or-later
// Photons that come to media straight from a light, or by lobes that store none. The includer declares the block
// Photons and includes common/photon.glsl and common/path_depth.glsl before.

// Whether no medium and no surface that stores photons has scattered a photon before. What other lobes sent straight
// from a light to a point in a medium, the final gather there does not look for.
bool has_come_straight(uint photon) {
    return medium_count(photons[photon].bounce_counts) == 0u && (photons[photon].flags & PHOTON_INDIRECT) == 0u;
}
