// SPDX-License-Identifier: GPL-3.0-or-later
// The rectangle that a triangle may touch on the plane z = 1, seen through a cone such as a whole face.
#include "deep_cubemap/cone_overlap.glsl"

// `cone`: (least x, greatest x, least y, greatest y) at z = 1. Points nearer than `min_depth`, where dividing by the
// depth no longer says where they are, may be anywhere in it.
void widen_by_point(vec3 point, vec4 cone, float margin, float min_depth, inout vec4 extent) {
    if (point.z <= min_depth) {
        extent = cone.xzyw;
    } else {
        extent = vec4(min(extent.xy, (point.xy - margin) / point.z), max(extent.zw, (point.xy + margin) / point.z));
    }
}

void widen_by_edge(vec3 a, vec3 b, vec4 inside_a, vec4 inside_b, vec4 cone, float margin, float min_depth,
                   inout vec4 extent) {
    float from, to;
    if (!clip_edge(inside_a, inside_b, from, to)) return;
    widen_by_point(mix(a, b, from), cone, margin, min_depth, extent);
    widen_by_point(mix(a, b, to), cone, margin, min_depth, extent);
}

// The triangle's extent (least x, least y, greatest x, greatest y), not cut to the cone; false if it is not seen
// through it. `tip`: how near the cone's tip a triangle may be anywhere.
bool cone_extent(vec3 a, vec3 b, vec3 c, vec4 cone, float margin, float min_depth, float tip, out vec4 extent) {
    vec4 inside_a = inside_cone(a, cone, margin);
    vec4 inside_b = inside_cone(b, cone, margin);
    vec4 inside_c = inside_cone(c, cone, margin);
    if (least(max(max(inside_a, inside_b), inside_c)) < 0.0 || max(max(a.z, b.z), c.z) < -margin) return false;
    extent = vec4(1e30, 1e30, -1e30, -1e30);
    if (least(min(min(inside_a, inside_b), inside_c)) >= 0.0) {
        widen_by_point(a, cone, margin, min_depth, extent);
        widen_by_point(b, cone, margin, min_depth, extent);
        widen_by_point(c, cone, margin, min_depth, extent);
    } else {
        widen_by_edge(a, b, inside_a, inside_b, cone, margin, min_depth, extent);
        widen_by_edge(b, c, inside_b, inside_c, cone, margin, min_depth, extent);
        widen_by_edge(c, a, inside_c, inside_a, cone, margin, min_depth, extent);
        ConeCorners triangle = prepare_corners(a, b, c);
        for (int corner = 0; corner < 4; ++corner) {
            float depth;
            vec2 position = vec2((corner & 1) != 0 ? cone.y : cone.x, (corner & 2) != 0 ? cone.w : cone.z);
            if (corner_depth(triangle, corner, cone, margin, depth)) {
                widen_by_point(vec3(position * max(depth, 0.0), depth), cone, margin, min_depth, extent);
            }
        }
        if (touches_tip(triangle, b, c, tip)) extent = cone.xzyw;
    }
    return true;
}
