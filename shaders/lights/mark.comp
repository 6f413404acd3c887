#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Emissive triangles carry their leaf of the light tree, and their traits.

layout(local_size_x = 64) in;

#include <MarkParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { MarkParameters parameters; };
layout(std430, binding = 0) readonly buffer EmissiveTriangles;
layout(std430, binding = 1) buffer Triangles;
layout(std430, binding = 2) readonly buffer EmitterLeaves { uint emitter_leaves[]; };  // nodes of the light tree

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    EmissiveTriangle emissive = emissive_triangles[index];
    uint triangle = emissive.triangle - parameters.first_triangle;  // wraps around for those before
    if (triangle >= parameters.triangle_count) return;
    triangle_vertices[3u * triangle + 1u].w = float(emitter_leaves[index]);
    triangle_vertices[3u * triangle + 2u].w = float(emissive.traits);
}
