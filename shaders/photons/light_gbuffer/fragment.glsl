// SPDX-License-Identifier: GPL-3.0-or-later
// A fragment is a texel of a job's rectangle: whether the triangle is in its cone, exact but for an outward margin, and
// over which depths. Not by the rasterizer's own rules: what lies between texels' centers must not be missed.
#include <LightGBufferParameters>
uniform Parameters { LightGBufferParameters parameters; };
#define TEXELS_ACCESS
#include "photons/light_gbuffer/views.glsl"
#include "photons/light_gbuffer/jobs.glsl"
#include "acceleration/triangles.glsl"
#include "deep_cubemap/cone_overlap.glsl"

flat in uint job_number;
flat in ivec2 view_corner;

struct TexelFragment {
    LightView view;
    uint texel;
    uint triangle;
    vec2 depths;
    bool is_covered;
};

TexelFragment texel_fragment() {
    uvec4 job = light_jobs[job_number];
    LightView view = light_views[job.y];
    ivec2 texel = ivec2(gl_FragCoord.xy) - view_corner;
    vec3 a = view_point(view, triangle_vertices[3u * job.x].xyz);
    vec3 b = view_point(view, triangle_vertices[3u * job.x + 1u].xyz);
    vec3 c = view_point(view, triangle_vertices[3u * job.x + 2u].xyz);
    vec2 depths;
    bool is_covered = cone_depths(a, b, c, texel_cone(view, texel), view.margin, depths);
    return TexelFragment(view, texel_number(job.y, texel), job.x, depths, is_covered);
}

bool before_horizon(TexelFragment fragment) {
    return fragment.is_covered && fragment.depths.x <= texel_horizon(fragment.view, light_texels[fragment.texel]);
}
