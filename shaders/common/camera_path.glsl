// SPDX-License-Identifier: GPL-3.0-or-later
#include <CameraPath>

// Flags of camera paths. STRAIGHT: nothing but transparency so far; SURFACE_FOUND: the passes have their
// surface; GATHERED: it has left a surface that stores photons, for light that others send there; CAUSTIC: since
// then, something has scattered it or taken a share of direct light. The others tell of the last event that was not
// straight on.
const uint PATH_STRAIGHT = 1u, PATH_SURFACE_FOUND = 2u, PATH_GATHERED = 4u, PATH_DIFFUSE = 8u, PATH_TRANSMITTED = 16u,
           PATH_SINGULAR = 32u, PATH_CAUSTIC = 64u;
