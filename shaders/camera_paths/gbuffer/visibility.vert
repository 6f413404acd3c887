#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// DirectCameraHits: every triangle, projected by the camera of the band.

#include "camera_paths/gbuffer/projections.glsl"
readonly buffer Camera;
readonly buffer Triangles;
#include "camera_paths/gbuffer/rasterize.glsl"

flat out uint triangle;
out float view_depth;

void main() {
    triangle = uint(gl_VertexID) / 3u;
    vec3 p = camera_space(triangle_vertices[gl_VertexID].xyz);
    view_depth = p.z;
    gl_Position = clip_position(p);
}
