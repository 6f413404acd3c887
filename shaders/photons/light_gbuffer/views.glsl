// SPDX-License-Identifier: GPL-3.0-or-later
// The views of lights, and their texels. A texel is the cone from the view's tip through a square of its window; its
// view's margin holds all rays that leave the light that way, wherever on the light they start.
// Needs the member side of the parameters.
#include <LightView>
#include <LightTexel>
readonly buffer LightViews { LightView light_views[]; };
TEXELS_ACCESS buffer LightTexels { LightTexel light_texels[]; };

// More than this would take as long to test as tracing does.
const uint MOST_TRIANGLES = 24u;

// Lateral, lateral, depth: from the tip in meters.
vec3 view_point(LightView view, vec3 point) {
    vec3 offset = point - view.center;
    return vec3(dot(offset, view.right), dot(offset, view.up), dot(offset, view.forward) + view.tip_distance);
}

// The window on the plane at depth 1, (least x, greatest x, least y, greatest y).
vec4 view_window(LightView view) { return view.tangent * vec4(-1.0, 1.0, -1.0, 1.0); }

float texel_size(LightView view) { return 2.0 * view.tangent / float(parameters.side); }

vec4 texel_cone(LightView view, ivec2 texel) {
    vec2 low = vec2(texel) * texel_size(view) - view.tangent, high = vec2(texel + 1) * texel_size(view) - view.tangent;
    return vec4(low, high).xzyw;
}

uint texel_number(uint view, ivec2 texel) {
    return (view * parameters.side + uint(texel.y)) * parameters.side + uint(texel.x);
}

// Depth up to which a texel has all triangles: a few texels' widths behind where the first of them has ended, so that
// those that share a surface are in it.
float texel_horizon(LightView view, LightTexel texel) {
    float depth = uintBitsToFloat(~texel.depth_complement);
    return depth + 4.0 * texel_size(view) * depth;
}
