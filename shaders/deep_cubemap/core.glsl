// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles near the center. There cells are thinner than the rounding of a ray's points, so rays
// test this list instead of cells while they are within deep_cubemap.core_radius.

#ifdef DEEP_CUBEMAP_BUILD
#define CORE_TRIANGLES_ACCESS writeonly
#else
#define CORE_TRIANGLES_ACCESS restrict readonly
#endif

CORE_TRIANGLES_ACCESS buffer CoreTriangles { uint core_triangles[]; };
