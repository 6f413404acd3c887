// SPDX-License-Identifier: GPL-3.0-or-later
// The rectangle that a triangle may touch on a face.
#include "deep_cubemap/cone_overlap.glsl"
#include "deep_cubemap/extents.glsl"

// Nearer than this many margins, dividing by the depth no longer says where a point is.
const float LEAST_MARGINS = 16.0;

void widen_by_point(vec3 point, float margin, inout vec4 extent) {
    if (point.z <= LEAST_MARGINS * margin) {
        extent = vec4(-1.0, -1.0, 1.0, 1.0);
    } else {
        extent = vec4(min(extent.xy, (point.xy - margin) / point.z), max(extent.zw, (point.xy + margin) / point.z));
    }
}

void widen_by_edge(vec3 a, vec3 b, vec4 inside_a, vec4 inside_b, float margin, inout vec4 extent) {
    float from, to;
    if (!clip_edge(inside_a, inside_b, from, to)) return;
    widen_by_point(mix(a, b, from), margin, extent);
    widen_by_point(mix(a, b, to), margin, extent);
}

// The triangle's extent on a face; false if it is not seen through this face.
bool face_extent(vec3 a, vec3 b, vec3 c, float margin, out uvec2 packed_extent) {
    const vec4 face = vec4(-1.0, 1.0, -1.0, 1.0);
    vec4 inside_a = inside_cone(a, face, margin);
    vec4 inside_b = inside_cone(b, face, margin);
    vec4 inside_c = inside_cone(c, face, margin);
    if (least(max(max(inside_a, inside_b), inside_c)) < 0.0 || max(max(a.z, b.z), c.z) < -margin) return false;
    vec4 extent = vec4(1e30, 1e30, -1e30, -1e30);
    if (least(min(min(inside_a, inside_b), inside_c)) >= 0.0) {
        widen_by_point(a, margin, extent);
        widen_by_point(b, margin, extent);
        widen_by_point(c, margin, extent);
    } else {
        widen_by_edge(a, b, inside_a, inside_b, margin, extent);
        widen_by_edge(b, c, inside_b, inside_c, margin, extent);
        widen_by_edge(c, a, inside_c, inside_a, margin, extent);
        ConeCorners triangle = prepare_corners(a, b, c);
        for (int corner = 0; corner < 4; ++corner) {
            float depth;
            vec2 position = vec2((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0);
            if (corner_depth(triangle, corner, face, margin, depth)) {
                widen_by_point(vec3(position * max(depth, 0.0), depth), margin, extent);
            }
        }
        if (touches_tip(triangle, b, c, LEAST_MARGINS * margin)) extent = vec4(-1.0, -1.0, 1.0, 1.0);
    }
    extent = extent * 0.5 + 0.5;
    if (any(lessThan(extent.zw, vec2(-1e-5))) || any(greaterThan(extent.xy, vec2(1.0 + 1e-5)))) return false;
    packed_extent = pack_extent(extent.xy, extent.zw);
    return true;
}
