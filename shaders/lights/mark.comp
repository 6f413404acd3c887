#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Emissive triangles carry the probability of being chosen, and their traits.

layout(local_size_x = 64) in;

#include <MarkParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { MarkParameters parameters; };
layout(std430, binding = 0) readonly buffer EmissiveTriangles;
layout(std430, binding = 1) buffer Triangles;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    EmissiveTriangle emissive = emissive_triangles[index];
    uint triangle = emissive.triangle - parameters.first_triangle;  // wraps around for those before
    if (triangle >= parameters.triangle_count) return;
    triangle_vertices[3u * triangle + 1u].w = emissive.share;
    triangle_vertices[3u * triangle + 2u].w = float(emissive.traits);
}
