// SPDX-License-Identifier: GPL-3.0-or-later
// The world-space triangles, three vertices each (w unused).

#ifdef TEXEL_BUFFERS
layout(rgba32f, binding = 2) restrict readonly uniform imageBuffer Triangles;
vec4 triangle_vertex(uint number) { return imageLoad(Triangles, int(number)); }
#else
layout(std430, binding = 8) restrict readonly buffer Triangles;
vec4 triangle_vertex(uint number) { return triangle_vertices[number]; }
#endif
