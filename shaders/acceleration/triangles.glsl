// SPDX-License-Identifier: GPL-3.0-or-later
// The world-space triangles, three vertices each (w unused).

restrict readonly buffer Triangles;
vec4 world_vertex(uint number) { return triangle_vertices[number]; }
