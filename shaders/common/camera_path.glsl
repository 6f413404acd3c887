// SPDX-License-Identifier: GPL-3.0-or-later
#include <CameraPath>

// Flags of camera paths. STRAIGHT: nothing but transparency so far; SURFACE_FOUND: the passes have their surface;
// DENOISING_DATA_FOUND: and those of denoisers theirs; GATHERED: it has left a surface that stores photons, for light
// that others send there; CAUSTIC: since then, something has scattered it or taken a share of direct light;
// GATHERED_AGAIN: it has left a second such surface. The others describe the last event that was not straight on.
// LIGHTS_FOUND: a shadow ray has looked for the light objects and emissive triangles that it leads to. SEEN_THROUGH:
// since that event it has passed surfaces that stop no shadow rays from there. The flag below is PATH_DISPERSED.
const uint PATH_STRAIGHT = 1u, PATH_SURFACE_FOUND = 2u, PATH_GATHERED = 4u, PATH_DIFFUSE = 8u, PATH_TRANSMITTED = 16u,
           PATH_SINGULAR = 32u, PATH_CAUSTIC = 64u, PATH_GATHERED_AGAIN = 128u, PATH_DENOISING_DATA_FOUND = 256u,
           PATH_LIGHTS_FOUND = 512u, PATH_SEEN_THROUGH = 2048u;

// Whether a path whose ray came to a surface sets out to gather, from there or again: in corners, within some distance
// of where the ray began, the disk in which photons count reaches beyond the surface, to where there are none;
// and on strands and points everywhere, whose rays count as of length LENGTH_ON_ROUND_SHAPES.
const float LENGTH_ON_ROUND_SHAPES = -1.0;
bool path_gathers(uint flags, float ray_length, float again_below) {
    return (flags & PATH_GATHERED) == 0u || ((flags & PATH_CAUSTIC) == 0u && ray_length < again_below);
}
