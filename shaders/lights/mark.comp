#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Emissive triangles carry the probability of being chosen, and their traits.

layout(local_size_x = 64) in;

#include <CountParameters>
#include "common/invocation.glsl"
layout(std140, binding = 0) uniform Parameters { CountParameters parameters; };
layout(std430, binding = 0) readonly buffer EmissiveTriangles;
layout(std430, binding = 1) buffer Triangles;

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    EmissiveTriangle emissive = emissive_triangles[index];
    triangle_vertices[3u * emissive.triangle + 1u].w = emissive.share;
    triangle_vertices[3u * emissive.triangle + 2u].w = float(emissive.traits);
}
