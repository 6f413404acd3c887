#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A thread a view and triangle: the texels that it may be seen in.
layout(local_size_x = 64) in;

#include <LightGBufferParameters>
#include "common/invocation.glsl"
#include "common/finite.glsl"
uniform Parameters { LightGBufferParameters parameters; };
#define TEXELS_ACCESS readonly
#include "photons/light_gbuffer/views.glsl"
#include "photons/light_gbuffer/jobs.glsl"
#include "acceleration/triangles.glsl"
#include "deep_cubemap/cone_bounds.glsl"

void main() {
    uint index = invocation_index();
    if (index >= parameters.view_count * parameters.triangle_count) return;
    uint number = index / parameters.triangle_count, triangle = index % parameters.triangle_count;
    LightView view = light_views[number];
    vec3 a = view_point(view, triangle_vertices[3u * triangle].xyz);
    vec3 b = view_point(view, triangle_vertices[3u * triangle + 1u].xyz);
    vec3 c = view_point(view, triangle_vertices[3u * triangle + 2u].xyz);
    if (!is_finite(a) || !is_finite(b) || !is_finite(c)) return;
    vec4 extent;
    float tip = view.margin * (2.0 + 1.0 / view.tangent);
    if (!cone_extent(a, b, c, view_window(view), view.margin, view.min_depth, tip, extent)) return;
    // A part of a texel more covers the rounding of the division.
    vec4 texels = (extent / view.tangent * 0.5 + 0.5) * float(parameters.side) + vec4(-0.125, -0.125, 0.125, 0.125);
    float last = float(parameters.side) - 1.0;
    if (any(lessThan(texels.zw, vec2(0.0))) || any(greaterThan(texels.xy, vec2(last + 1.0)))) return;
    uvec4 rectangle = uvec4(clamp(floor(texels), 0.0, last));
    // Counted past the capacity as well, so that the host learns how much is needed.
    uint slot = atomicAdd(light_counts.jobs, 1u);
    if (slot >= parameters.job_capacity) return;
    light_jobs[slot] = uvec4(triangle, number, rectangle.x | rectangle.y << 16, rectangle.z | rectangle.w << 16);
}
