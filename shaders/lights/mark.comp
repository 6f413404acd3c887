#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Emissive triangles carry their leaf of the light tree, and their traits.

layout(local_size_x = 64) in;

#include <MarkParameters>
#include "common/invocation.glsl"
uniform Parameters { MarkParameters parameters; };
readonly buffer EmissiveTriangles;
buffer Triangles;
readonly buffer EmitterLeaves { uint emitter_leaves[]; };  // nodes of the light tree

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    EmissiveTriangle emissive = emissive_triangles[index];
    uint triangle = emissive.triangle - parameters.first_triangle;  // wraps around for those before
    if (triangle >= parameters.triangle_count) return;
    triangle_vertices[3u * triangle + 1u].w = float(emitter_leaves[index]);
    triangle_vertices[3u * triangle + 2u].w = float(emissive.traits);
}
