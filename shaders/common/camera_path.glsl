// SPDX-License-Identifier: GPL-3.0-or-later
#include <CameraPath>
#include <CameraPathFlags>

// Whether a path whose ray came to a surface sets out to gather, from there or again: in corners, within some distance
// of where the ray began, the disk in which photons count reaches beyond the surface, to where there are none;
// and on strands and points everywhere, whose rays count as of length LENGTH_ON_ROUND_SHAPES.
const float LENGTH_ON_ROUND_SHAPES = -1.0;
bool path_gathers(uint flags, float ray_length, float again_below) {
    return (flags & PATH_GATHERED) == 0u || ((flags & PATH_CAUSTIC) == 0u && ray_length < again_below);
}
