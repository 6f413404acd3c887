// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of emissive triangles beside their radiance. Needs the storage block Triangles.
#include <EmitterTraits>

// 0 of a triangle that does not emit.
uint emitter_traits(uint triangle) { return uint(triangle_vertices[3u * triangle + 2u].w); }
