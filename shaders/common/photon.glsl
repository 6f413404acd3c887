// SPDX-License-Identifier: GPL-3.0-or-later
#include <Photon>

// The numbers of rppm_addon/integrator/records.py.
const uint PHOTON_ACTIVE = 1u, PHOTON_STORED = 2u, PHOTON_ESCAPED = 4u, PHOTON_DIFFUSED = 8u,
           PHOTON_INDIRECT = 16u, PHOTON_DIRECT = 32u, PHOTON_NOT_DIFFUSE = 64u, PHOTON_NOT_GLOSSY = 128u, PHOTON_NOT_TRANSMITTED = 256u,
           PHOTON_CASTS_SHADOWS = 512u;

// Photons that a diffuse surface has scattered are spread evenly and estimated with a wider radius;
// those straight from a light or by specular surfaces only make the caustics and keep the narrow one.
float photon_radius(uint flags, float narrow, float wide) {
    return (flags & PHOTON_DIFFUSED) != 0u ? max(narrow, wide) : narrow;
}
