// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle against the cone of a cell (or of a whole face): exact but for an outward margin.
// The common part of a triangle and a cone is a polygon. Its corners lie on the triangle's edges, or
// where one of the cone's four corner lines pierces the triangle, or at the cone's tip. Edges are
// clipped one by one and need no orientation, so triangles seen edge-on, slivers and triangles around
// the center are treated like all others. Everything is in face coordinates about the center.

// Distances (scaled) from the cone's four planes, positive inside, planes moved out by the margin.
vec4 inside_cone(vec3 point, vec4 bounds, float margin) {
    return vec4(point.x - bounds.x * point.z, bounds.y * point.z - point.x, point.y - bounds.z * point.z,
                bounds.w * point.z - point.y)
           + margin;
}

float least(vec4 v) { return min(min(v.x, v.y), min(v.z, v.w)); }
float greatest(vec4 v) { return max(max(v.x, v.y), max(v.z, v.w)); }

// Part [from, to] of the edge between two points that is in the cone, given the points' inside_cone.
bool clip_edge(vec4 inside_a, vec4 inside_b, out float from, out float to) {
    bvec4 a_is_out = lessThan(inside_a, vec4(0.0));
    bvec4 b_is_out = lessThan(inside_b, vec4(0.0));
    vec4 crossing = inside_a / (inside_a - inside_b);  // used only where the signs differ
    from = greatest(mix(vec4(0.0), crossing, a_is_out));
    to = least(mix(vec4(1.0), crossing, b_is_out));
    return least(max(inside_a, inside_b)) >= 0.0 && from <= to;
}

struct ConeCorners {
    vec3 plane_normal;  // of the triangle, not of unit length
    vec3 a;
    vec3 edge_moments0, edge_moments1, edge_moments2;
    vec3 edge0, edge1, edge2;
};

// What the corner lines of any cone need of a triangle. An edge's moment shows on which side of the
// edge a line through the center passes.
ConeCorners prepare_corners(vec3 a, vec3 b, vec3 c) {
    return ConeCorners(cross(b - a, c - a), a, cross(b, c - b), cross(c, a - c), cross(a, b - a), b - c, c - a, a - b);
}

// Depth at which the cone's corner line (0 to 3) pierces the triangle.
bool corner_depth(ConeCorners triangle, int corner, vec4 bounds, float margin, out float depth) {
    bool right = (corner & 1) != 0, top = (corner & 2) != 0;
    vec3 direction = vec3(right ? bounds.y : bounds.x, top ? bounds.w : bounds.z, 1.0);
    vec3 start = vec3(right ? margin : -margin, top ? margin : -margin, 0.0);
    vec3 sides = vec3(dot(direction, triangle.edge_moments0 + cross(start, triangle.edge0)),
                      dot(direction, triangle.edge_moments1 + cross(start, triangle.edge1)),
                      dot(direction, triangle.edge_moments2 + cross(start, triangle.edge2)));
    float approach = dot(direction, triangle.plane_normal);
    depth = dot(triangle.a - start, triangle.plane_normal) / approach;
    bool between = all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
    return between && approach != 0.0 && depth >= -margin;
}

// Whether the triangle may come within `reach` of the center along every axis.
// Planes that are moved out meet behind the center, margin / tan(half the cone's angle) deep: so far
// around the center the polygon has corners that are neither on edges nor on corner lines. Without
// this, triangles that contain the center or almost do would seem to begin at their edges.
bool touches_tip(ConeCorners triangle, vec3 b, vec3 c, float reach) {
    vec3 low = min(min(triangle.a, b), c), high = max(max(triangle.a, b), c);
    return all(lessThanEqual(low, vec3(reach))) && all(greaterThanEqual(high, vec3(-reach)))
           && abs(dot(triangle.a, triangle.plane_normal)) <= reach * dot(abs(triangle.plane_normal), vec3(1.0));
}

void widen(float depth, inout vec2 interval) { interval = vec2(min(interval.x, depth), max(interval.y, depth)); }

void widen_by_edge(vec3 a, vec3 b, vec4 inside_a, vec4 inside_b, inout vec2 interval) {
    float from, to;
    if (!clip_edge(inside_a, inside_b, from, to)) return;
    widen(mix(a.z, b.z, from), interval);
    widen(mix(a.z, b.z, to), interval);
}

// Depth interval of the triangle within the cone, rounded outwards; false if they do not touch.
bool cone_depths(vec3 a, vec3 b, vec3 c, vec4 bounds, float margin, out vec2 interval) {
    interval = vec2(1e30, -1e30);
    vec4 inside_a = inside_cone(a, bounds, margin);
    vec4 inside_b = inside_cone(b, bounds, margin);
    vec4 inside_c = inside_cone(c, bounds, margin);
    if (least(max(max(inside_a, inside_b), inside_c)) < 0.0) return false;
    vec2 range = vec2(min(min(a.z, b.z), c.z), max(max(a.z, b.z), c.z));
    if (least(min(min(inside_a, inside_b), inside_c)) >= 0.0) {
        interval = range;
    } else {
        widen_by_edge(a, b, inside_a, inside_b, interval);
        widen_by_edge(b, c, inside_b, inside_c, interval);
        widen_by_edge(c, a, inside_c, inside_a, interval);
        ConeCorners triangle = prepare_corners(a, b, c);
        for (int corner = 0; corner < 4; ++corner) {
            float depth;
            if (corner_depth(triangle, corner, bounds, margin, depth)) {
                widen(clamp(depth, range.x, range.y), interval);
            }
        }
        // the planes meet 2 * margin / (bounds.y - bounds.x) behind the center
        if (touches_tip(triangle, b, c, margin * (2.0 + 2.0 / (bounds.y - bounds.x))))
            interval.x = min(interval.x, 0.0);
    }
    if (interval.x > interval.y || interval.y < -margin) return false;
    interval = max(interval + vec2(-1.0, 1.0) * (margin + 1e-6 * abs(interval)), vec2(0.0));
    return true;
}
