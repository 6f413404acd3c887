#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The scene's triangles with the plain surfaces of their materials.

#include "camera_paths/gbuffer/projections.glsl"
#include <FirstLookParameters>
#include <FirstLookDrawn>
#include "common/geometry.glsl"

uniform Parameters { FirstLookParameters parameters; };
readonly buffer Camera;
readonly buffer Triangles;
readonly buffer Attributes;
readonly buffer PlainSurfaces;
readonly buffer InstanceOpacities;
#include "camera_paths/gbuffer/rasterize.glsl"

flat out uint material;
flat out uint instance;
flat out float opacity;
out float view_depth;
out vec3 to_viewer;
out vec3 normal;

void main() {
    uint triangle = uint(gl_VertexID) / 3u, corner = uint(gl_VertexID) % 3u;
    TriangleAttributes shading = attributes[triangle];
    material = shading.material;
    instance = shading.instance;
    float instance_opacity = instance_opacities[instance];
    opacity = plain_surfaces[material].opacity * instance_opacity;
    vec3 point = triangle_vertices[gl_VertexID].xyz;
    normal = unpack_unit_vector(corner == 0u ? shading.normal0 : corner == 1u ? shading.normal1 : shading.normal2);
    to_viewer = camera.projection == PROJECTION_ORTHOGRAPHIC ? -camera.forward : camera.position - point;
    vec3 p = camera_space(point);
    view_depth = p.z;
    gl_Position = clip_position(p);
    // A holdout, of opacity 0, hides what is behind it; what is transparent is drawn when all else is there.
    bool solid = opacity >= 1.0 || instance_opacity == 0.0;
    bool drawn = (parameters.drawn & (solid ? DRAWN_SOLID : DRAWN_TRANSPARENT)) != 0u;
    if (instance_opacity < 0.0 || !drawn) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
