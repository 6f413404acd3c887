// SPDX-License-Identifier: GPL-3.0-or-later
#include <Photon>

#include <PhotonFlags>
#include <PhotonHistory>
#include <PhotonNumbers>
#include "common/medium_vertices.glsl"
#include <PhotonsInMedia>

uint photon_path_of(uint word) { return word & ((1u << PHOTON_SEGMENT_SHIFT) - 1u); }

#include "common/disk_radius.glsl"
#include <PhotonFootprints>

// A radius as the upper bits of the flags, rounded down to 14 bits; 0 is none.
uint footprint_bits(float radius) { return floatBitsToUint(clamp(radius, 1e-30, 1e30)) & ~PHOTON_FLAG_MASK; }

// The radius in which a photon counts at an importon. Photons that a diffuse surface has scattered are spread evenly
// and estimated with a wider one. Those straight from a light or by specular surfaces only make the caustics, and know
// how far from each other they are (photons/differentials.glsl).
float photon_radius(uint flags, float minimum, float maximum, float wide) {
    float disk = disk_radius(minimum, maximum);
    if ((flags & PHOTON_AFTER_ROUGH_BOUNCE) != 0u) return max(disk, wide);
    float footprint = uintBitsToFloat(flags & ~PHOTON_FLAG_MASK);
    return footprint > 0.0 ? clamp(footprint, minimum, maximum) : disk;
}
