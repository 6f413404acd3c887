#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// DirectCameraHits: every triangle, projected by the camera of the band.

#include "gbuffer/projections.glsl"
layout(std430, binding = 0) readonly buffer Camera;
layout(std430, binding = 1) readonly buffer Triangles;

flat out uint triangle;
out float view_depth;

void main() {
    triangle = uint(gl_VertexID) / 3u;
    vec3 offset = triangle_vertices[gl_VertexID].xyz - camera.position;
    vec3 p = vec3(dot(offset, camera.right), dot(offset, camera.up), dot(offset, camera.forward));
    view_depth = p.z;
    vec2 middle = camera.window.xz + camera.window.yw, extent = camera.window.yw - camera.window.xz;
    float near = camera.clip_start, far = camera.clip_end;
    if (camera.projection == PROJECTION_ORTHOGRAPHIC)
        gl_Position = vec4((2.0 * p.xy - middle) / extent, (2.0 * p.z - near - far) / (far - near), 1.0);
    else
        gl_Position = vec4((2.0 * p.xy - middle * p.z) / extent,
                           ((far + near) * p.z - 2.0 * far * near) / (far - near), p.z);
}
