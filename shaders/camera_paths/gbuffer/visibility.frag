#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// The number of the nearest triangle, as two 16-bit parts that floats hold exactly.

#include "camera_paths/gbuffer/projections.glsl"
readonly buffer Camera;
#include "camera_paths/gbuffer/rasterize.glsl"

flat in uint triangle;
in float view_depth;
layout(location = 0) out vec2 visible;

void main() {
    gl_FragDepth = fragment_depth(view_depth);
    uint number = triangle + 1u;
    visible = vec2(float(number & 0xffffu), float(number >> 16u));
}
