// SPDX-License-Identifier: GPL-3.0-or-later
#include <Photon>

#include <PhotonFlags>

// Photons that a diffuse surface has scattered are spread evenly and estimated with a wider radius;
// those straight from a light or by specular surfaces only make the caustics and keep the narrow one.
float photon_radius(uint flags, float narrow, float wide) {
    return (flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u ? max(narrow, wide) : narrow;
}
