#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// How far nodes move vertices, each asked at the corner of a triangle that it is of.

layout(local_size_x = 64) in;

#include <DisplaceParameters>
#include <DisplacedVertex>
#include "common/invocation.glsl"
uniform Parameters { DisplaceParameters parameters; };
#include "materials/data.glsl"
#include "materials/surface.glsl"
readonly buffer DisplacedVertices { DisplacedVertex displaced_vertices[]; };
writeonly buffer Offsets { vec4 offsets[]; };

#include "materials/generated.glsl"

// As Cycles sees it: smooth, from straight above, and by rays of no kind.
Surface surface_of(DisplacedVertex vertex) {
    vec3 v0, v1, v2;
    triangle_points(vertex.triangle, v0, v1, v2);
    Surface surface;
    surface.triangle = vertex.triangle;
    surface.instance = attributes[vertex.triangle].instance;
    surface.barycentrics = vec3(vertex.corner == 0u, vertex.corner == 1u, vertex.corner == 2u);
    surface.beside = vec3(0.0);
    surface.position = vertex.corner == 0u ? v0 : vertex.corner == 1u ? v1 : v2;
    surface.uv = triangle_uv(vertex.triangle, surface.barycentrics);
    vec3 face = cross(v1 - v0, v2 - v0), n = normal_to_world(surface, vertex.normal);
    float size = length(n);
    surface.geometric = face / max(length(face), 1e-30);
    surface.normal = size > 1e-20 ? n / size : surface.geometric;
    surface.viewer = surface.normal;
    surface.backfacing = false;
    surface.ray = 0u;
    surface.ray_length = 0.0;
    surface.ray_depth = surface.transparent_depth = surface.portal_depth = 0u;
    return surface;
}

void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    DisplacedVertex vertex = displaced_vertices[index];
    Surface surface = surface_of(vertex);
    vec3 way = material_displacement(surface, vertex.first_constant);
    offsets[index] = vec4(direction_to_object(surface, way), 0.0);
}
